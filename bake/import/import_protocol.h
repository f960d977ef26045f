// SPDX-License-Identifier: Apache-2.0
// Between importMeshInWorker and the program relief-import: descriptors, arguments and exit codes.
//
//     relief-import PATH MEMORY SECONDS TRIANGLES KIND [FIELD VALUE]… names [NAME…]
//
// PATH is the mesh as the user named it (for messages, its name and extension); MEMORY in bytes; TRIANGLES as
// ImportLimits; KIND a word of ImportKind; FIELD and VALUE as fields() of ImportOptions has them; each NAME one of ImportOptions::names.
// Nothing is read from standard input or written to standard output.
//
// For an image, KIND is kImportImage and the result is a pipe, which is kImportAliveFd as well. Behind the first byte it gets an
// ImageSize and then each row, floats, each behind a u32 that is 0. Any other u32 is an ErrorCode, behind which the length of the
// error's text, a u32, and the text are the last. The byte order is the machine's.
#pragma once

#include <fcntl.h>

#include <cerrno>
#include <cstdint>
#include <string_view>

namespace relief {

inline constexpr std::string_view kImportNamesFollow = "names";  ///< the end of the fields

inline constexpr std::string_view kImportImage = "image";

struct ImageSize {
    std::uint64_t columns = 0;
    std::uint64_t rows = 0;
    std::uint64_t most = 0;  ///< SampleRows::most()
};

inline constexpr int kImportMeshFd = 3;    ///< the file's bytes, sealed, memfd
inline constexpr int kImportFolderFd = 4;  ///< its folder, O_PATH; /dev/null if there is none
inline constexpr int kImportResultFd =
    5;  ///< memfd, large enough for any message; cut to size and sealed. Or a pipe
/// A pipe's writing end: gets a byte when the worker starts, before it reads anything; closes as it ends.
inline constexpr int kImportAliveFd = 6;

inline constexpr int kImportExitMessage = 0;     ///< the message is complete: a mesh or an error
inline constexpr int kImportExitMemory = 10;     ///< the memory limit is reached
inline constexpr int kImportExitArguments = 11;  ///< invalid arguments, or the parent has ended
inline constexpr int kImportExitTooLarge = 12;   ///< the message is larger than the memory for it
/// Plus the errno of a system call that failed.
inline constexpr int kImportExitErrno = 128;

/// Allocates the first bytes of a memfd now: touching a page that cannot be allocated raises SIGBUS.
/// \return 0 or an errno: ENOSPC and ENOMEM where the system has no more.
[[nodiscard]] inline int reserveMemory(int file, std::uint64_t bytes) {
    while (bytes != 0 && ::fallocate(file, 0, 0, static_cast<off_t>(bytes)) != 0) {
        if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

/// Seals a memfd; none of its pages may be mapped for writing. \return 0 or an errno.
[[nodiscard]] inline int addSeals(int file, int seals) {
    return ::fcntl(file, F_ADD_SEALS, seals) == 0 ? 0 : errno;
}

}  // namespace relief
