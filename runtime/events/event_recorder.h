// SPDX-License-Identifier: Apache-2.0
// Events of a particle system: each step records hits and deaths, and the CPU receives lists of them later.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "formats/base/result.h"
#include "runtime/events/event_list.h"
#include "runtime/particles/particle_system.h"

namespace relief {

/// Starts recording events with the next step; nullopt stops recording. Recording is off by default and then costs
/// nothing. Recompiles the step's shaders if recording starts or stops. Pending lists are lost.
/// Errors: kUsage (invalid options), kLimit, kUnsupported (too few draw buffers), kFailure.
[[nodiscard]] Result<void> setEvents(ParticleSystem& particles, const std::optional<EventOptions>& options);
/// Records several lists, each with its own selection; an event may be in more than one.
/// \param lists  up to kEventLists.
[[nodiscard]] Result<void> setEvents(ParticleSystem& particles, std::span<const EventOptions> lists);

/// Lists the events of the last step on the GPU and requests their read-back. Restores the GL state. Collect each
/// request, because the ids of replaced particles stay in memory until then.
/// \param tag  returned with the events, for example the number of the step.
/// \return false, without effect, if EventList::kInFlightMax lists are pending or events are not recorded.
bool requestEvents(ParticleSystem& particles, std::uint64_t tag);
/// Returns the lists of the oldest pending request if the GPU has finished them; never waits.
[[nodiscard]] std::optional<StepEvents> pollEvents(ParticleSystem& particles);
/// Waits for the lists of the oldest pending request; nullopt if no request is pending.
/// Errors: kFailure (no response from the GPU for ten seconds, or its memory cannot be read).
[[nodiscard]] Result<std::optional<StepEvents>> waitEvents(ParticleSystem& particles);
[[nodiscard]] int eventsInFlight(const ParticleSystem& particles);
/// Returns the GPU's lists for the last request, for your own shaders; null without setEvents().
[[nodiscard]] const EventList* eventList(const ParticleSystem& particles);

}  // namespace relief
