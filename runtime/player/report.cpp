// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/report.h"

#include <cstdio>

#include "formats/fields/json.h"
#include "runtime/player/events_log.h"
#include "runtime/player/scene_check.h"

namespace relief {

std::string reportText(const PlayerReport& report) {
    char text[256];
    std::snprintf(text, sizeof(text),
                  "%u steps, %.2f ms each; %llu born, %llu died, %u alive, %llu rejected; %u frames\n",
                  report.scene.time.steps, report.ms_per_step,
                  static_cast<unsigned long long>(report.counts.born),
                  static_cast<unsigned long long>(report.counts.died), report.counts.alive,
                  static_cast<unsigned long long>(report.counts.rejected), report.frames_written);
    return report.device + ", " + std::string(stepPathName(report.path)) + " shaders\n" + text;
}

GeneratedTexts playerSchemas() {
    return {
        schemaFile("sim-report", "relief-sim --json", "A run of a scene.", PlayerReport{}),
        schemaFile("sim-check", "relief-sim --check --json", "The check of a scene.",
                   std::variant<CheckReport, CheckFailure>{}),
        schemaFile("sim-events", "relief-sim --events", "One line: a hit of one particle.", HitLine{}),
    };
}

void fields(FieldVisitor& visit, const PlayerReport& report) {
    visit("settings", report.scene, {"Simulated scene, with the keys of a scene file"});
    visit("device", report.device, {"OpenGL version, renderer and platform"});
    visit("shaders", stepPathName(report.path),
          {.help = "Shaders of the particle steps", .words = kWords<"fragment", "compute">});
    const auto collider = [&](FieldVisitor& visit_collider) {
        visit_collider("maps", report.collider_maps, {"Maps of all colliders"});
        visit_collider("gpu_bytes", report.collider_bytes, {"Size on the GPU", "bytes"});
    };
    visit("collider", group(collider), {"All colliders"});
    const auto particles = [&](FieldVisitor& visit_particles) {
        visit_particles("alive", report.counts.alive, {"Live particles at the end"});
        visit_particles("born", report.counts.born, {"Particles born"});
        visit_particles("died", report.counts.died, {"Particles that died"});
        visit_particles("rejected", report.counts.rejected, {"Births rejected because the system was full"});
        visit_particles("in_contact", report.in_contact, {"Particles in contact in the last step"});
        visit_particles("collisions", report.collisions, {"Steps in contact, summed over live particles"});
    };
    visit("particles", group(particles), {"Particle counts"});
    visit("steps", report.scene.time.steps, {"Steps played"});
    visit("ms_per_step", report.ms_per_step, {"Mean time of a step", "ms", kFromZero});
    visit("ms_per_step_median", report.ms_per_step_median, {"Median time of a step", "ms", kFromZero});
    visit("frames", report.frames_written, {"Pictures written"});
    visit("dumps", report.dumps_written, {"Particle dumps written"});
    visit("warnings", report.warnings, {"Likely errors in the scene, one line each"});
}

}  // namespace relief
