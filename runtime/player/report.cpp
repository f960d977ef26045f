#include "runtime/player/report.h"

#include <cstdio>

#include "formats/fields/json.h"
#include "runtime/player/events_log.h"
#include "runtime/player/scene_check.h"

namespace relief {

std::string reportText(const PlayerReport& report) {
    char text[256];
    std::snprintf(text, sizeof(text),
                  "%u steps, %.2f ms each; %llu born, %llu died, %u alive, %llu found no room; %u frames\n",
                  report.scene.time.steps, report.ms_per_step,
                  static_cast<unsigned long long>(report.counts.born),
                  static_cast<unsigned long long>(report.counts.died), report.counts.alive,
                  static_cast<unsigned long long>(report.counts.refused), report.frames_written);
    return report.device + ", " + std::string(stepPathName(report.path)) + " path\n" + text;
}

GeneratedTexts playerSchemas() {
    return {
        schemaFile("sim-report", "relief-sim --json", "A run of a scene.", schemaOf(PlayerReport{})),
        schemaFile("sim-check", "relief-sim --check --json", "The check of a scene.",
                   schemaOf(std::variant<CheckReport, CheckFailure>{})),
        schemaFile("sim-events", "relief-sim --events", "One line: a hit of one particle.",
                   schemaOf(HitLine{})),
    };
}

}  // namespace relief
