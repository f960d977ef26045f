// Wavefront OBJ: the statements v and f.
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/base/text.h"
#include "formats/base/text_scanner.h"
#include "runtime/files/mesh_file.h"

namespace relief {
namespace {

bool readNumber(std::string_view word, float& out) {
    out = static_cast<float>(parseDouble(word).value_or(NAN));
    return std::isfinite(out);
}

class ObjReader {
  public:
    ObjReader(std::string_view text, std::string_view name) : name_(name), text_(text, {'#', true}) {}

    Result<PictureMesh> read() {
        do {
            const std::string_view statement = text_.word();
            if (statement == "v" || statement == "f") {
                RELIEF_TRY(statement == "v" ? readVertex() : readFace());
            }
        } while (text_.nextLine());
        if (mesh_.triangles.empty()) {
            return fail(ErrorCode::kInvalidInput, std::string(name_) + " has no faces");
        }
        return std::move(mesh_);
    }

  private:
    [[nodiscard]] tl::unexpected<Error> failHere(ErrorCode code, const std::string& message) const {
        return fail(code, std::string(name_) + ", line " + std::to_string(text_.line()) + ": " + message);
    }

    Result<void> readVertex() {
        if (mesh_.positions.size() == kMeshVerticesMax) {
            return failHere(ErrorCode::kLimit,
                            "more than " + std::to_string(kMeshVerticesMax) + " vertices; simplify the mesh");
        }
        glm::vec3 p{0.0F};
        for (int i = 0; i < 3; ++i) {
            if (!readNumber(text_.word(), p[i])) {
                return failHere(ErrorCode::kInvalidInput, "a vertex needs three finite numbers");
            }
        }
        mesh_.positions.push_back(p);
        return {};
    }

    // Corners are "7", "7/1", "7//3" or "7/1/3"; below 0 they count back from the last vertex so far.
    Result<void> readFace() {
        corners_.clear();
        for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
            const std::string_view digits = word.substr(0, word.find('/'));
            std::int64_t index = 0;
            const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
            const auto count = static_cast<std::int64_t>(mesh_.positions.size());
            const std::int64_t at = index < 0 ? count + index : index - 1;
            if (error != std::errc() || rest != digits.data() + digits.size() || at < 0 || at >= count) {
                return failHere(ErrorCode::kInvalidInput,
                                "a face names a vertex that is not there; there are " +
                                    std::to_string(count) + " so far");
            }
            corners_.push_back(static_cast<std::uint32_t>(at));
        }
        if (corners_.size() < 3) {
            return failHere(ErrorCode::kInvalidInput, "a face needs three corners");
        }
        if (!addPolygon(corners_, mesh_)) {
            return failHere(ErrorCode::kLimit, "more than " + std::to_string(kMeshTrianglesMax) +
                                                   " triangles; simplify the mesh");
        }
        return {};
    }

    std::string_view name_;
    TextScanner text_;
    std::vector<std::uint32_t> corners_;
    PictureMesh mesh_;
};

}  // namespace

Result<PictureMesh> parseObj(std::string_view text, std::string_view name) {
    return ObjReader(text, name).read();
}

}  // namespace relief
