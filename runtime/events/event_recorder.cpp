// SPDX-License-Identifier: Apache-2.0
#include "runtime/events/event_recorder.h"

#include <algorithm>
#include <array>
#include <deque>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

std::uint32_t materialCount(const ShaderCollider* collider) {
    return collider == nullptr ? 0 : static_cast<std::uint32_t>(collider->materialNames().size());
}

class EventRecorder : public StepFeature {
  public:
    using Outputs = std::array<GlTexture, 2>;  // velocity and surface, as written by step_event.glsl
    EventRecorder(EventList list, Outputs outputs, double time)
        : list_(std::move(list)), outputs_(std::move(outputs)), begin_(time), end_(time) {}

    [[nodiscard]] std::string defines() const override { return "#define RELIEF_EVENTS\n"; }
    [[nodiscard]] bool readsMaterials() const override { return true; }
    [[nodiscard]] Result<void> check(const ShaderCollider* collider) const override;
    [[nodiscard]] std::span<const GlTexture> outputs() const override { return outputs_; }
    void replaced(std::uint32_t index, std::uint32_t id) override {
        if (newest_.size() <= index) {
            newest_.resize(std::size_t{index} + 1);
        }
        replaced_.push_back({steps_, id, newest_[index]});
        newest_[index] = dropped_ + replaced_.size();
    }
    void beforeStep(double begin, double end, std::uint32_t extent, const ShaderCollider* collider) override;

    [[nodiscard]] const EventList& list() const { return list_; }
    /// Replaces the lists for subsequent steps.
    void replaceList(EventList list) {
        list_ = std::move(list);
        dropped_ += replaced_.size();
        replaced_.clear();
        extent_ = 0;
    }
    bool request(const ParticleSystem& particles, std::uint64_t tag);
    [[nodiscard]] std::optional<StepEvents> poll(const ParticleSystem& particles);
    [[nodiscard]] Result<std::optional<StepEvents>> wait(const ParticleSystem& particles);

  private:
    /// Restores the full ids at the time of the step.
    [[nodiscard]] StepEvents withIds(const ParticleSystem& particles, EventList::Collected collected) const;

    struct Replaced {        // an id that a birth replaced
        std::uint64_t step;  // the last step with this id
        std::uint32_t id;
        std::uint64_t previous;  // entry of the id before this id, numbered like newest_
    };
    EventList list_;
    Outputs outputs_;
    std::deque<Replaced> replaced_;      // since the oldest pending list
    std::uint64_t dropped_ = 0;          // removed from the front of replaced_
    std::vector<std::uint64_t> newest_;  // for each particle, 1 + the number of its newest entry; 0: none
    // The last step; steps_ counts from creation.
    std::uint64_t steps_ = 0;
    double begin_ = 0.0;
    double end_ = 0.0;
    std::uint32_t extent_ = 0;
    std::uint32_t materials_ = 0;
};

Result<void> EventRecorder::check(const ShaderCollider* collider) const {
    const std::size_t bodies = collider == nullptr ? 1 : std::max<std::size_t>(collider->bodyCount(), 1);
    const std::size_t materials = materialCount(collider);
    if ((bodies + 1) * (materials + 1) > EventList::kPlacesMax) {
        return fail(ErrorCode::kLimit,
                    "events cannot distinguish " + std::to_string(materials) + " materials of " +
                        std::to_string(bodies) + " bodies: at most " + std::to_string(EventList::kPlacesMax) +
                        " pairs; give materials the same names, or bake with --materials drop");
    }
    return {};
}

void EventRecorder::beforeStep(double begin, double end, std::uint32_t extent,
                               const ShaderCollider* collider) {
    // Drop entries that neither a pending list nor the list of the next step can need.
    const std::uint64_t oldest = list_.oldestNumber().value_or(steps_ + 1);
    while (!replaced_.empty() && replaced_.front().step < oldest) {
        replaced_.pop_front();
        ++dropped_;
    }
    ++steps_;
    begin_ = begin;
    end_ = end;
    extent_ = extent;
    materials_ = materialCount(collider);
}

bool EventRecorder::request(const ParticleSystem& particles, std::uint64_t tag) {
    const PassState state;
    return list_.request({outputs_[0], outputs_[1], particles.positionsBefore(), particles.births(),
                          particles.textureWidth(), extent_, particles.types(), tag, steps_, begin_, end_,
                          materials_});
}

std::optional<StepEvents> EventRecorder::poll(const ParticleSystem& particles) {
    auto collected = list_.poll();
    return collected ? std::optional(withIds(particles, std::move(*collected))) : std::nullopt;
}

Result<std::optional<StepEvents>> EventRecorder::wait(const ParticleSystem& particles) {
    auto collected = RELIEF_TRY(list_.wait());
    return collected ? std::optional(withIds(particles, std::move(*collected))) : std::nullopt;
}

StepEvents EventRecorder::withIds(const ParticleSystem& particles, EventList::Collected collected) const {
    for (ParticleEvent& event : collected.events.events) {
        event.id = particles.idOf(event.index);
        // Go back to the first id that was replaced after the event.
        std::uint64_t at = event.index < newest_.size() ? newest_[event.index] : 0;
        while (at > dropped_) {
            const Replaced& one = replaced_[static_cast<std::size_t>(at - 1 - dropped_)];
            if (one.step < collected.number) {
                break;
            }
            event.id = one.id;
            at = one.previous;
        }
    }
    return std::move(collected.events);
}

}  // namespace

Result<void> setEvents(ParticleSystem& particles, const std::optional<EventOptions>& options) {
    return setEvents(particles, options ? std::span(&*options, 1) : std::span<const EventOptions>());
}

Result<void> setEvents(ParticleSystem& particles, std::span<const EventOptions> lists) {
    auto* const old = particles.feature<EventRecorder>();
    if (lists.empty()) {
        return old == nullptr ? Result<void>{} : particles.replaceFeature(old, nullptr);
    }
    const PassState state;
    auto list = RELIEF_TRY(EventList::create(lists, particles.capacity()));
    if (old != nullptr) {
        old->replaceList(std::move(list));
        return {};
    }
    clearGlErrors();
    EventRecorder::Outputs outputs{particles.makeStateTexture(), particles.makeStateTexture()};
    RELIEF_TRY(checkAllocated("the events of " + std::to_string(particles.capacity()) + " particles",
                              "choose a smaller capacity"));
    return particles.replaceFeature(
        nullptr, std::make_shared<EventRecorder>(std::move(list), std::move(outputs), particles.time()));
}

bool requestEvents(ParticleSystem& particles, std::uint64_t tag) {
    auto* const recorder = particles.feature<EventRecorder>();
    return recorder != nullptr && recorder->request(particles, tag);
}

std::optional<StepEvents> pollEvents(ParticleSystem& particles) {
    auto* const recorder = particles.feature<EventRecorder>();
    return recorder == nullptr ? std::nullopt : recorder->poll(particles);
}

Result<std::optional<StepEvents>> waitEvents(ParticleSystem& particles) {
    auto* const recorder = particles.feature<EventRecorder>();
    return recorder == nullptr ? std::optional<StepEvents>() : recorder->wait(particles);
}

int eventsInFlight(const ParticleSystem& particles) {
    const auto* const recorder = particles.feature<EventRecorder>();
    return recorder == nullptr ? 0 : recorder->list().inFlight();
}

const EventList* eventList(const ParticleSystem& particles) {
    const auto* const recorder = particles.feature<EventRecorder>();
    return recorder == nullptr ? nullptr : &recorder->list();
}

}  // namespace relief
