#include "bake/import/import_xml.h"

#include <expat.h>

#include <algorithm>
#include <exception>
#include <new>
#include <utility>

#include "formats/base/text.h"

namespace relief {
namespace {

constexpr std::size_t kChunk = 1 << 16;
constexpr std::size_t kQuotedMax = 40;  // bytes of the file shown in a message

std::string_view local(std::string_view name) {
    return name.substr(name.find(':') + 1);  // npos + 1 is 0
}

std::string lineText(std::size_t line) {
    return "line " + std::to_string(line) + ": ";
}

/// A byte is the character of its number, which is right of Latin letters at least.
int keepBytes(void* /*data*/, const XML_Char* /*name*/, XML_Encoding* info) {
    for (int i = 0; i < 256; ++i) {
        info->map[i] = i;
    }
    info->data = nullptr;
    info->convert = nullptr;
    info->release = nullptr;
    return XML_STATUS_OK;
}

struct Piece {
    XmlReader::Event event = XmlReader::Event::kDone;
    std::size_t line = 1;
    std::string words;  // the element's name, or the text
    std::vector<XmlReader::Attribute> attributes;
};

}  // namespace

struct XmlReader::State {
    explicit State(std::span<const std::byte> document) : rest(document), parser(XML_ParserCreate(nullptr)) {
        if (parser == nullptr) {
            throw std::bad_alloc();
        }
        XML_SetHashSalt(parser,
                        1);  // else Expat draws a random one by a system call that the sandbox forbids
        XML_SetUserData(parser, this);
        XML_SetElementHandler(parser, begin, end);
        XML_SetCharacterDataHandler(parser, characters);
        XML_SetEntityDeclHandler(parser, declareEntity);
        XML_SetSkippedEntityHandler(parser, skipEntity);
        XML_SetUnknownEncodingHandler(parser, keepBytes, nullptr);
    }
    ~State() { XML_ParserFree(parser); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    /// Exceptions must not pass Expat's frames.
    template <class F>
    static void guarded(void* data, F f) {
        State& state = *static_cast<State*>(data);
        if (state.thrown) {
            return;  // Expat still ends an empty element
        }
        try {
            f(state);
        } catch (...) {
            state.thrown = std::current_exception();
            XML_StopParser(state.parser, XML_FALSE);
        }
    }
    static void begin(void* data, const XML_Char* name, const XML_Char** attributes) {
        guarded(data, [&](State& state) {
            state.open.emplace_back(name);
            std::vector<Attribute>& into = state.add(Event::kBegin, name).attributes;
            std::size_t count = 0;
            for (; *attributes != nullptr; attributes += 2, ++count) {
                into.resize(std::max(into.size(), count + 1));
                into[count].name = attributes[0];
                into[count].value = attributes[1];
            }
            into.resize(count);
        });
    }
    static void end(void* data, const XML_Char* name) {
        guarded(data, [&](State& state) {
            state.open.pop_back();
            state.add(Event::kEnd, name);
        });
    }
    static void characters(void* data, const XML_Char* text, int size) {
        guarded(data, [&](State& state) { state.words.append(text, static_cast<std::size_t>(size)); });
    }
    static void declareEntity(void* data, const XML_Char* name, int, const XML_Char*, int, const XML_Char*,
                              const XML_Char*, const XML_Char*, const XML_Char*) {
        refuseEntity(data, name);
    }
    static void skipEntity(void* data, const XML_Char* name, int) { refuseEntity(data, name); }
    static void refuseEntity(void* data, const XML_Char* name) {
        guarded(data, [&](State& state) {
            state.refused = "'" + cleanUtf8(name, kQuotedMax) + "' is no character that XML knows";
            XML_StopParser(state.parser, XML_FALSE);
        });
    }

    Piece& add(Event event, const char* name) {
        if (words.find_first_not_of(" \t\r\n") != std::string::npos) {
            addPiece(Event::kText).words = words;
        }
        words.clear();
        Piece& piece = addPiece(event);
        piece.words = name;
        return piece;
    }
    Piece& addPiece(Event event) {
        if (filled == pieces.size()) {
            pieces.emplace_back();
        }
        Piece& piece = pieces[filled++];
        piece.event = event;
        piece.line = XML_GetCurrentLineNumber(parser);
        return piece;
    }

    /// Reads on until there is a piece, or the end.
    void read() {
        filled = taken = 0;
        while (filled == 0 && !ended) {
            const std::size_t size = std::min(rest.size(), kChunk);
            ended = size == rest.size();
            const bool good = XML_Parse(parser, reinterpret_cast<const char*>(rest.data()),
                                        static_cast<int>(size), ended ? 1 : 0) == XML_STATUS_OK;
            rest = rest.subspan(size);
            if (thrown != nullptr) {
                std::rethrow_exception(thrown);
            }
            if (!good) {
                ended = true;
                failure = "its XML is damaged: " + lineText(XML_GetCurrentLineNumber(parser)) + faultText();
            }
        }
    }
    [[nodiscard]] std::string faultText() const {
        const XML_Error error = XML_GetErrorCode(parser);
        if (error == XML_ERROR_NO_MEMORY) {
            throw std::bad_alloc();
        }
        if (!refused.empty()) {
            return refused;
        }
        if (error == XML_ERROR_TAG_MISMATCH && !open.empty()) {
            return "an end tag does not end <" + cleanUtf8(open.back(), kQuotedMax) + ">, which is open";
        }
        const bool cut = error == XML_ERROR_NO_ELEMENTS || error == XML_ERROR_UNCLOSED_TOKEN ||
                         error == XML_ERROR_PARTIAL_CHAR || error == XML_ERROR_UNCLOSED_CDATA_SECTION;
        return cut && !open.empty() ? "it ends within <" + cleanUtf8(open.back(), kQuotedMax) +
                                          ">; it was probably cut off, copy or export it again"
                                    : XML_ErrorString(error);
    }

    std::span<const std::byte> rest;
    XML_Parser parser;
    std::vector<Piece> pieces;  // reused, so that their strings keep their memory
    std::size_t filled = 0;
    std::size_t taken = 0;
    std::string words;              // since the last tag
    std::vector<std::string> open;  // elements, where Expat is
    bool ended = false;
    std::string failure;  // once the pieces are used up
    std::string refused;
    std::exception_ptr thrown;

    Piece now;
    std::vector<Attribute> attributes;
    std::vector<std::string> path;  // of the event
};

XmlReader::XmlReader(std::span<const std::byte> document) : state_(std::make_unique<State>(document)) {}
XmlReader::~XmlReader() = default;
XmlReader::XmlReader(XmlReader&&) noexcept = default;

Result<XmlReader::Event> XmlReader::next() {
    State& state = *state_;
    if (state.now.event == Event::kEnd) {
        state.path.pop_back();
    }
    state.now.event = Event::kDone;
    if (state.taken == state.filled) {
        state.read();
    }
    if (state.taken == state.filled) {
        return state.failure.empty() ? Result<Event>(Event::kDone) : invalidInput(state.failure);
    }
    std::swap(state.now, state.pieces[state.taken++]);
    if (state.now.event == Event::kBegin) {
        state.path.push_back(state.now.words);
        std::swap(state.attributes, state.now.attributes);
    }
    return state.now.event;
}

std::string_view XmlReader::name() const {
    return local(state_->path.back());
}

bool XmlReader::at(std::initializer_list<std::string_view> path) const {
    return std::equal(path.begin(), path.end(), state_->path.begin(), state_->path.end(),
                      [](std::string_view a, std::string_view b) { return a == local(b); });
}

std::size_t XmlReader::depth() const {
    return state_->path.size();
}

std::optional<std::string> XmlReader::attribute(std::string_view name) const {
    for (const Attribute& attribute : state_->attributes) {
        if (local(attribute.name) == name && !attribute.name.starts_with("xmlns:")) {
            return attribute.value;
        }
    }
    return std::nullopt;
}

const std::vector<XmlReader::Attribute>& XmlReader::attributes() const {
    return state_->attributes;
}

const std::string& XmlReader::text() const {
    return state_->now.words;
}

std::string XmlReader::where() const {
    return lineText(state_->now.line);
}

}  // namespace relief
