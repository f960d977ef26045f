// SPDX-License-Identifier: Apache-2.0
// Events of a particle system: each step records what hit and what died, and lists of these come to the CPU later.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "formats/base/result.h"
#include "runtime/events/event_list.h"
#include "runtime/particles/particle_system.h"

namespace relief {

/// From the next step on, each step records the event of every particle. nullopt: no longer, as at first; a step
/// then costs nothing more, in time or memory. Compiles the step where that changes; what is under way is lost.
/// Errors: kUsage (the options), kLimit, kUnsupported (a GL that draws to fewer textures), kFailure.
[[nodiscard]] Result<void> setEvents(ParticleSystem& particles, const std::optional<EventOptions>& options);
/// The same with several lists, each of events of its own; an event may be in more than one.
/// \param lists  up to kEventLists.
[[nodiscard]] Result<void> setEvents(ParticleSystem& particles, std::span<const EventOptions> lists);

/// Lists the events of the last step on the GPU, and requests their read-back. Restores the GL state. Collect each request:
/// until then every id that a birth takes the place of is kept.
/// \param tag  comes back with them, the number of the step for example.
/// \return false, and nothing is done, while EventList::kInFlightMax lists are under way, and without setEvents().
bool requestEvents(ParticleSystem& particles, std::uint64_t tag);
/// The oldest list, if the GPU has finished it: never waits.
[[nodiscard]] std::optional<StepEvents> pollEvents(ParticleSystem& particles);
/// The oldest list, which the GPU is waited for; nullopt if none is under way.
/// Errors: kFailure (the GPU has not answered for ten seconds, or its memory cannot be read).
[[nodiscard]] Result<std::optional<StepEvents>> waitEvents(ParticleSystem& particles);
[[nodiscard]] int eventsInFlight(const ParticleSystem& particles);
/// The list of the last request on the GPU, for shaders of your own; null without setEvents().
[[nodiscard]] const EventList* eventList(const ParticleSystem& particles);

}  // namespace relief
