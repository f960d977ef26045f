// Between importMeshInWorker and the program relief-import: descriptors, arguments and exit codes.
//
//     relief-import PATH UNIT UP MEMORY SECONDS [NAME…]
//
// PATH is the mesh's as the user gave it (for messages, its name and extension); UNIT and UP as
// ImportOptions, "-" for none; MEMORY in bytes; each NAME one of ImportOptions::names.
// Nothing is read from standard input or written to standard output.
#pragma once

namespace relief {

inline constexpr int kImportMeshFd = 3;    ///< the mesh file's bytes, sealed, memfd
inline constexpr int kImportFolderFd = 4;  ///< its folder, O_PATH; /dev/null if there is none
inline constexpr int kImportResultFd = 5;  ///< memfd, large enough for any message; cut to size and sealed
inline constexpr int kImportAliveFd = 6;   ///< a pipe's writing end: closes as the worker ends

inline constexpr int kImportExitMessage = 0;     ///< the message is there, a mesh or an error
inline constexpr int kImportExitMemory = 10;     ///< the memory limit is reached
inline constexpr int kImportExitArguments = 11;  ///< called otherwise than above, or the parent is gone
inline constexpr int kImportExitTooLarge = 12;   ///< the message is larger than the memory for it
/// Of the dynamic loader, which could not load a library, or of a program that could not be run.
inline constexpr int kImportExitNotLoaded = 127;
/// And behind it: 128 + errno, of a call of the system without which there is no message.
inline constexpr int kImportExitErrno = 128;

}  // namespace relief
