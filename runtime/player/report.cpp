#include "runtime/player/report.h"

#include <cstdio>

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

}  // namespace relief
