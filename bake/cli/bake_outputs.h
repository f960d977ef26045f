// The options of `relief bake` about its output.
#pragma once

#include <cstdint>
#include <string>

#include "formats/base/field.h"

namespace relief {

struct BakeOutputs {
    std::uint32_t compress = 0;
    bool json = false;
    std::string depfile;
};

template <class Visitor, FieldsOf<BakeOutputs> Outputs>
void fields(Visitor& visit, Outputs& outputs) {
    visit("compress", outputs.compress,
          {.help = "zstd level of the texels, 0 (none) to 19",
           .range = {0.0, 19.0},
           .value = "LEVEL",
           .must = "0 (none) to 19 (smallest)"});
    visit("json", outputs.json, {.help = "Print a report as JSON to standard output"});
    visit("depfile", outputs.depfile,
          {.help = "Also write which files were read, for Make and Ninja: every input of the output",
           .value = "FILE"});
}

}  // namespace relief
