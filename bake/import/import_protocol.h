// SPDX-License-Identifier: Apache-2.0
// Defines the protocol between importMeshInWorker and the program relief-import: descriptors, arguments and exit codes.
//
//     relief-import PATH MEMORY SECONDS TRIANGLES KIND [FIELD VALUE]… names [NAME…]
//
// PATH is the path of the mesh as given by the user, for its extension and for messages. MEMORY is in bytes. SECONDS
// limits processor time. TRIANGLES is ImportLimits::triangles. KIND is a name of ImportKind. FIELD and VALUE follow
// fields() of ImportOptions. Each NAME is an entry of ImportOptions::names. The worker does not use standard input or
// output.
//
// For an image, KIND is kImportImage; one pipe is both kImportResultFd and kImportAliveFd. After the first byte, the
// pipe carries an ImageSize and then each row as floats; a u32 of 0 precedes each of these. Any other u32 is an
// ErrorCode; the length of the error text (u32) and the text follow and end the stream. Byte order is native.
//
// A mesh or an error is serialized to a message, which the parent validates like any file. Layout: a u32 that is 0 or
// an ErrorCode, then the members of a TriangleMesh (exchange() in import_message.cpp) or the error text. A u64 length
// precedes each text, list and array.
#pragma once

#include <fcntl.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::string_view kImportNamesMarker = "names";  ///< ends the list of fields

inline constexpr std::string_view kImportImage = "image";

struct ImageSize {
    std::uint64_t columns = 0;
    std::uint64_t rows = 0;
    std::uint64_t most = 0;  ///< SampleRows::most()
};

inline constexpr int kImportMeshFd = 3;    ///< memfd with the file's bytes, sealed
inline constexpr int kImportFolderFd = 4;  ///< folder of the mesh, O_PATH; /dev/null if there is none
inline constexpr int kImportResultFd =
    5;  ///< memfd, large enough for any message, then truncated and sealed; or a pipe
/// Write end of a pipe. The worker writes one byte when it starts, before it reads anything, and closes the pipe when
/// it ends.
inline constexpr int kImportAliveFd = 6;

inline constexpr int kImportExitMessage = 0;     ///< the message, a mesh or an error, is complete
inline constexpr int kImportExitMemory = 10;     ///< the memory limit was reached
inline constexpr int kImportExitArguments = 11;  ///< invalid arguments, or the parent has ended
inline constexpr int kImportExitTooLarge = 12;   ///< the message exceeds the result memory
/// Added to the errno of the system call that failed.
inline constexpr int kImportExitErrno = 128;

/// Allocates the first `bytes` bytes of a memfd now; otherwise a page that cannot be allocated raises SIGBUS on access.
/// \return 0, or an errno: ENOSPC or ENOMEM if the system is out of memory.
[[nodiscard]] inline int reserveMemory(int file, std::uint64_t bytes) {
    while (bytes != 0 && ::fallocate(file, 0, 0, static_cast<off_t>(bytes)) != 0) {
        if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

/// Seals a memfd; no writable mapping may exist. \return 0 or an errno.
[[nodiscard]] inline int addSeals(int file, int seals) {
    return ::fcntl(file, F_ADD_SEALS, seals) == 0 ? 0 : errno;
}

/// Returns the size of the message in bytes. \param raw  the result of importRaw.
[[nodiscard]] std::uint64_t importMessageSize(const Result<TriangleMesh>& raw);

/// Writes the whole message. \param target  importMessageSize(raw) bytes.
void writeImportMessage(const Result<TriangleMesh>& raw, std::span<std::byte> target);

/// Reads and validates an untrusted message. TriangleMesh::marks and labels are empty or have one entry per triangle.
/// finishMesh() validates indices and coordinates, and ImportSource::finish() validates the values of marks.
/// \param bytes         must not change during the call.
/// \param triangle_max  at most kTriangleMax. A message with more triangles, or with more than three times as many
/// positions, is rejected before allocation.
/// \return the worker's result of importRaw. Errors: the worker's error, as one line; kInvalidInput, without the file
/// name, for a malformed message.
[[nodiscard]] Result<TriangleMesh> readImportMessage(std::span<const std::byte> bytes,
                                                     std::uint64_t triangle_max = kTriangleMax);

}  // namespace relief
