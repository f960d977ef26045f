// SPDX-License-Identifier: Apache-2.0
// Plan files: a plan that its text gives again, or one line that names file, line and column.
#include <string_view>

#include "bake/plan/plan_file.h"
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto plan = relief::parsePlan(text, "plan.toml");
    if (!plan) {
        mustHold(plan.error().message.starts_with("plan.toml"), "an error names the file");
        mustBeLine(plan.error().message);
        return 0;
    }
    const auto again = relief::parsePlan(relief::planText(*plan), "plan.toml");
    mustHold(again.has_value(), "the text of a plan can be read");
    mustHold(again->quality == plan->quality && again->prefer == plan->prefer, "with the same settings");
    mustHold(again->maps.size() == plan->maps.size(), "and as many maps");
    for (std::size_t i = 0; i < plan->maps.size(); ++i) {
        mustHold(again->maps[i].spec == plan->maps[i].spec, "and the same ones");
    }
    return 0;
}
