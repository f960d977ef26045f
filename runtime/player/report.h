// The report of a run of relief-sim.
#pragma once

#include <string>

#include "formats/fields/generated.h"
#include "runtime/player/player.h"
#include "runtime/scene/scene_json.h"

namespace relief {

/// A few lines for people.
[[nodiscard]] std::string reportText(const PlayerReport& report);

/// The JSON Schemas of all that `relief-sim` prints and logs.
[[nodiscard]] GeneratedTexts playerSchemas();

/// "fragment" or "compute"; not of kAuto
[[nodiscard]] constexpr std::string_view stepPathName(StepPath path) {
    return path == StepPath::kCompute ? "compute" : "fragment";
}

/// `relief-sim --json`. Keys: README.md beside this file, "The report".
template <class Visitor, FieldsOf<PlayerReport> R>
void fields(Visitor& visit, R& report) {
    visit("settings", report.scene, {"Effective scene, by its own keys"});
    visit("device", report.device, {"OpenGL version, renderer and platform"});
    visit("path", stepPathName(report.path),
          {.help = "Shaders that moved the particles", .words = kWords<"fragment", "compute">});
    const auto collider = [&](auto& visit_collider) {
        visit_collider("maps", report.collider_maps, {"Maps of all colliders"});
        visit_collider("gpu_bytes", report.collider_bytes, {"Size on the GPU", "bytes"});
    };
    visit("collider", group(collider), {"All colliders"});
    const auto particles = [&](auto& visit_particles) {
        visit_particles("alive", report.counts.alive, {"Live particles at the end"});
        visit_particles("born", report.counts.born, {"Particles born"});
        visit_particles("died", report.counts.died, {"Particles that died"});
        visit_particles("refused", report.counts.refused, {"Births that found no room"});
        visit_particles("in_contact", report.in_contact,
                        {"Particles that touched something in the last step"});
        visit_particles("collisions", report.collisions, {"Steps in contact of all particles"});
    };
    visit("particles", group(particles), {"Numbers of particles"});
    visit("steps", report.scene.time.steps, {"Steps played"});
    visit("ms_per_step", report.ms_per_step, {"Mean time of a step", "ms", kFromZero});
    visit("ms_per_step_median", report.ms_per_step_median, {"Median time of a step", "ms", kFromZero});
    visit("frames", report.frames_written, {"Pictures written"});
    visit("dumps", report.dumps_written, {"States written"});
    visit("warnings", report.warnings, {"Probable mistakes, one line each"});
}

}  // namespace relief
