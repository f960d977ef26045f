#include "bake/import/import_fields.h"

namespace relief {

bool readForm(std::string_view word, UpAxis& axis) {
    const Result<UpAxis> read = parseUpAxis(word);
    axis = read.value_or(axis);
    return read.has_value();
}

std::string formText(UpAxis axis) {
    return std::string(upAxisName(axis));
}

std::span<const std::string_view> unitWords() {
    static const std::vector<std::string_view> kUnits = lengthUnits();
    return kUnits;
}

}  // namespace relief
