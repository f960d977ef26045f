#include "bake/cli/response_file.h"

#include "formats/base/error_context.h"
#include "formats/base/file_io.h"

namespace relief {
namespace {

tl::unexpected<Error> tooMany() {
    return fail(ErrorCode::kLimit, "the response files hold more than " + std::to_string(kResponseWordsMax) +
                                       " arguments; name fewer, or use a recipe");
}

/// Splits text as a shell does, without its expansions.
class WordReader {
  public:
    WordReader(std::string_view text, const std::string& name) : text_(text), name_(name) {}

    Result<std::vector<std::string>> read() {
        while (at_ < text_.size()) {
            const char c = text_[at_];
            if (isSpace(c)) {
                step();
            } else if (c == '#') {
                while (at_ < text_.size() && text_[at_] != '\n') {
                    step();
                }
            } else if (words_.size() == kResponseWordsMax) {
                return tooMany();
            } else
                RELIEF_TRY(readWord());
        }
        return std::move(words_);
    }

  private:
    static bool isSpace(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

    void step() { line_ += text_[at_++] == '\n' ? 1 : 0; }

    [[nodiscard]] tl::unexpected<Error> invalid(std::size_t line, const std::string& message) const {
        return fail(ErrorCode::kInvalidInput, name_ + ":" + std::to_string(line) + ": " + message);
    }

    Result<void> readWord() {
        std::string word;
        char quote = '\0';
        std::size_t quote_line = line_;
        for (; at_ < text_.size() && (quote != '\0' || !isSpace(text_[at_])); step()) {
            const char c = text_[at_];
            if (c == '\0') {
                return invalid(line_, "a zero byte, which no argument can hold; remove it");
            }
            if (c == quote) {
                quote = '\0';
            } else if (quote == '\0' && (c == '\'' || c == '"')) {
                quote = c;
                quote_line = line_;
            } else if (c == '\\' && quote != '\'') {
                if (at_ + 1 == text_.size()) {
                    return invalid(line_, "a backslash with nothing behind it; remove it, or write \\\\");
                }
                step();
                word += text_[at_];
            } else {
                word += c;
            }
        }
        if (quote != '\0') {
            return invalid(quote_line,
                           std::string("the quote ") + quote + " has no end; add it, or write \\" + quote);
        }
        words_.push_back(std::move(word));
        return {};
    }

    std::string_view text_;
    const std::string& name_;
    std::size_t at_ = 0;
    std::size_t line_ = 1;
    std::vector<std::string> words_;
};

struct Expander {
    FileGuard& files;
    std::vector<std::string> out = {};
    bool literal = false;   ///< behind --
    std::size_t total = 0;  ///< words of all files

    Result<void> add(const std::vector<std::string>& arguments, int depth) {
        for (const std::string& argument : arguments) {
            const bool names_file = !literal && argument.size() > 1 && argument.front() == '@';
            if (!names_file) {
                literal = literal || argument == "--";
                out.push_back(argument);
            } else if (argument[1] == '@') {
                out.push_back(argument.substr(1));
            } else
                RELIEF_TRY(addFile(argument.substr(1), depth));
        }
        return {};
    }

    Result<void> addFile(const std::string& path, int depth) {
        const std::string quoted = quotedPath(path);
        if (depth == kResponseDepthMax) {
            return fail(ErrorCode::kLimit, quoted + ": response files name each other more than " +
                                               std::to_string(kResponseDepthMax) +
                                               " deep; break the circle, or write @@ for a real @");
        }
        const auto bytes = RELIEF_TRY(inFront("response file", readFile(path, kResponseBytesMax)));
        RELIEF_TRY(files.reads(path));
        const std::vector<std::string> words =
            RELIEF_TRY(responseWords({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                     quoted.substr(1, quoted.size() - 2)));
        total += words.size();
        if (total > kResponseWordsMax) {
            return tooMany();
        }
        return add(words, depth + 1);
    }
};

}  // namespace

Result<std::vector<std::string>> responseWords(std::string_view text, const std::string& name) {
    return WordReader(text, name).read();
}

Result<std::vector<std::string>> expandArguments(const std::vector<std::string>& arguments,
                                                 FileGuard& files) {
    Expander expander{files};
    RELIEF_TRY(expander.add(arguments, 0));
    return std::move(expander.out);
}

}  // namespace relief
