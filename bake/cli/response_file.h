// Response files: `relief VERB @FILE` reads arguments from a file, for lists that are too long for a command
// line or that another program writes.
//
// An argument @FILE stands for the words of FILE, in its place. Words are separated by spaces and line ends;
// '…' and "…" keep what is between them together, and in "…" and outside of quotes a backslash takes the next
// character as it is. A # at the start of a word begins a comment that ends with its line. A word may again
// be an @FILE. @@… stands for an argument that begins with one @, and behind an argument -- nothing is
// expanded. FILE is found as any other file of the command line is: from the current folder.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/base/file_guard.h"
#include "formats/base/result.h"

namespace relief {

/// A response file within a response file, and so on: at most this deep.
inline constexpr int kResponseDepthMax = 10;
inline constexpr std::uint64_t kResponseBytesMax = std::uint64_t{1} << 20;  ///< of one file
/// Of all files together: a small file can name one often.
inline constexpr std::size_t kResponseWordsMax = 100'000;

/// The words of a response file's text.
/// \param name  of the file, for messages.
/// Errors: kInvalidInput (a quote without its end, a backslash at the very end, a zero byte) as "NAME:LINE:
/// …"; kLimit.
[[nodiscard]] Result<std::vector<std::string>> responseWords(std::string_view text, const std::string& name);

/// All arguments but the program's name, response files expanded. \param files  gets to know them.
/// Errors: kIo (a file cannot be read), kLimit (depth, size, number), those of responseWords.
[[nodiscard]] Result<std::vector<std::string>> expandArguments(const std::vector<std::string>& arguments,
                                                               FileGuard& files);

}  // namespace relief
