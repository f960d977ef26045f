// SPDX-License-Identifier: Apache-2.0
// relief.Simulation.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>

#include "bake/python/convert.h"
#include "bake/python/interruptible.h"
#include "formats/base/stopwatch.h"
#include "runtime/gl/gl_context.h"
#include "runtime/player/simulation.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {
namespace {

struct Hit : ParticleEvent {
    std::uint64_t step = 0;  ///< number of the step
};

/// A scene without a window. Only one simulation at a time has its context current on a thread.
class HeadlessSimulation {
  public:
    /// \param root  SceneOverrides::root.
    /// \param hits  whether to store hits for takeHits().
    HeadlessSimulation(const std::filesystem::path& scene, std::optional<std::uint64_t> seed,
                       const std::filesystem::path& root, bool hits)
        : context_(need(GlContext::create())) {
        SceneOverrides overrides;
        overrides.seed = seed;
        overrides.root = root;
        loaded_ = std::make_unique<LoadedScene>(need(released([&] { return loadAll(scene, overrides); })));
        simulation_ = std::make_unique<Simulation>(need(released([&] {
            return Simulation::create(*loaded_, {.checkpoint = [] {
                const py::gil_scoped_acquire held;
                raiseSignals();
            }});
        })));
        if (hits) {
            hits_ = std::make_unique<std::vector<Hit>>();
            need(simulation_->listHits(0.0F, [to = hits_.get()](const StepEvents& step) {
                for (const ParticleEvent& event : step.events) {
                    if (event.hit && !event.lasts) {
                        to->push_back({event, step.tag});
                    }
                }
                return Result<void>();
            }));
        }
    }
    ~HeadlessSimulation() {
        // If another thread collects this object, its GL objects are leaked: only the thread of the context may free
        // them.
        if (simulation_ && !context_->makeCurrent()) {
            static_cast<void>(simulation_.release());
            static_cast<void>(loaded_.release());
        }
    }

    void step(std::uint32_t count) {
        need(context_->makeCurrent());
        for (std::uint32_t i = 0; i < count; raiseSignals()) {
            need(released([&]() -> Result<void> {
                const Stopwatch watch;
                do {
                    RELIEF_TRY(simulation_->step());
                } while (++i < count && watch.ms() < static_cast<double>(kSignalInterval.count()));
                return {};
            }));
        }
    }

    [[nodiscard]] py::dict read() const {
        need(context_->makeCurrent());
        const auto states = need(simulation_->particles().readState());
        using State = ParticleState;
        return py::dict(py::arg("positions") = column(states, &State::position),
                        py::arg("velocities") = column(states, &State::velocity),
                        py::arg("ages") = column(states, &State::age),
                        py::arg("lifetimes") = column(states, &State::lifetime),
                        py::arg("ids") = column(states, &State::id),
                        py::arg("types") = column(states, &State::type),
                        py::arg("collisions") = column(states, &State::collisions));
    }

    [[nodiscard]] py::list takeWarnings() { return textsOf(simulation_->takeWarnings()); }

    /// Returns the hits of all steps since the last call; waits for the GPU.
    [[nodiscard]] py::dict takeHits() {
        if (!hits_) {
            raise({ErrorCode::kUsage, "this simulation stores no hits; create it with hits=True"});
        }
        need(context_->makeCurrent());
        need(simulation_->finishEvents());
        const std::vector<Hit> hits = std::exchange(*hits_, {});
        return py::dict(
            py::arg("step") = column(hits, &Hit::step), py::arg("time") = column(hits, &Hit::time),
            py::arg("id") = column(hits, &Hit::id), py::arg("type") = column(hits, &Hit::type),
            py::arg("body") = column(hits, &Hit::body), py::arg("material") = column(hits, &Hit::material),
            py::arg("position") = column(hits, &Hit::position),
            py::arg("normal") = column(hits, &Hit::normal),
            py::arg("velocity") = column(hits, &Hit::velocity), py::arg("speed") = column(hits, &Hit::speed));
    }

    [[nodiscard]] std::vector<std::string> materials() const {
        const auto names = simulation_->textures().materialNames();
        return {names.begin(), names.end()};
    }
    [[nodiscard]] double time() const { return simulation_->particles().time(); }
    [[nodiscard]] std::uint32_t alive() const { return simulation_->particles().counts().alive; }

  private:
    std::unique_ptr<GlContext> context_;
    std::unique_ptr<LoadedScene> loaded_;
    std::unique_ptr<std::vector<Hit>> hits_;  // null if hits are not stored
    std::unique_ptr<Simulation> simulation_;
};

}  // namespace

void addSimulation(py::module_& m) {
    py::class_<HeadlessSimulation>(m, "Simulation")
        .def(py::init<const std::filesystem::path&, std::optional<std::uint64_t>,
                      const std::filesystem::path&, bool>())
        .def("step", &HeadlessSimulation::step)
        .def("take_hits", &HeadlessSimulation::takeHits)
        .def("take_warnings", &HeadlessSimulation::takeWarnings)
        .def("read", &HeadlessSimulation::read)
        .def_property_readonly("materials", &HeadlessSimulation::materials)
        .def_property_readonly("time", &HeadlessSimulation::time)
        .def_property_readonly("alive", &HeadlessSimulation::alive);
}

}  // namespace relief
