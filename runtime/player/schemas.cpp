#include "runtime/player/schemas.h"

#include "formats/fields/json.h"
#include "runtime/player/logs.h"
#include "runtime/player/report.h"
#include "runtime/player/scene_check.h"

namespace relief {

GeneratedTexts playerSchemas() {
    return {
        schemaFile("sim-report", "relief-sim --json", "A run of a scene.", schemaOf(PlayerReport{})),
        schemaFile("sim-check", "relief-sim --check --json", "The check of a scene.",
                   schemaOf(std::variant<CheckReport, CheckFailure>{})),
        schemaFile("sim-stats", "relief-sim --stats", "One line of the statistics.",
                   schemaOf(StatisticsLine{})),
        schemaFile("sim-events", "relief-sim --events", "One line: a hit of one particle.",
                   schemaOf(HitLine{})),
    };
}

}  // namespace relief
