// SPDX-License-Identifier: Apache-2.0
#include "runtime/stream/world_stream.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/base/finite.h"
#include "formats/base/text.h"
#include "runtime/bodies/world_bodies.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/stream/texel_ranges.h"

namespace relief {
namespace {

constexpr std::size_t kTexelSize = 8;
/// Factor on the distance of resident colliders, as hysteresis.
constexpr float kResidentFactor = 0.9F;
/// Body-point distances to measure per update: some tens of microseconds.
constexpr std::size_t kPairsPerUpdate = 8192;
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// A collider of the world.
struct Streamed {
    std::size_t body = kNone;          // a body that uses it; kNone if there is none or it is not streamed
    std::size_t texels = 0;            // of its full map
    Collider coarse;                   // without texels, except texel 0, which stores the size of the tree
    std::optional<std::size_t> place;  // location of the full map's texels
    std::uint64_t last_wanted = 0;     // State::choices when it was last wanted
    std::uint64_t refused = kNone;     // State::era in which it did not fit
    bool requested = false;            // requested but not yet uploaded
    bool failed = false;
    bool present = false;  // resident with its full map
};

struct Upload {
    std::size_t collider = 0;
    Collider loaded;
    std::size_t done = 0;  // texels
};

bool isStreamable(const Collider& collider) {
    return collider.maps.size() == 1 && collider.maps[0].format == MapFormat::kPatches;
}

Result<void> checkPoints(std::span<const PointOfInterest> points) {
    for (const PointOfInterest& point : points) {
        if (!isFinite(point.position) || !std::isfinite(point.radius) || !(point.radius > 0.0F)) {
            return fail(ErrorCode::kUsage, "a point of interest must be finite, and its radius above 0");
        }
    }
    return {};
}

/// The initial state of the world.
struct Start {
    std::vector<Streamed> colliders;   // of the world
    std::vector<StreamBody> plan;      // bodies whose colliders are streamed
    std::vector<std::size_t> planned;  // index into `plan` for each body, or kNone
    std::uint64_t coarse_bytes = 0;    // of all permanently resident texels
    std::size_t texels = 0;            // of all streamed texels
};

Result<Start> layOut(const World& world, std::span<const ColliderBody> bodies,
                     std::span<const Collider* const> coarse) {
    Start start;
    start.colliders.resize(world.colliders.size());
    std::map<const Collider*, std::size_t> own;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        own[coarse[i]] = i;
    }
    std::set<const Collider*> counted;
    for (const ColliderBody& body : bodies) {
        const bool first = body.live || counted.insert(body.collider).second;
        start.coarse_bytes += first ? body.collider->texelBytes() : 0;
        const auto found = body.live ? own.end() : own.find(body.collider);
        const bool streamed = found != own.end() && world.colliders[found->second].coarse;
        start.planned.push_back(streamed ? start.plan.size() : kNone);
        if (!streamed) {
            continue;
        }
        const WorldCollider& named = world.colliders[found->second];
        start.plan.push_back({static_cast<std::uint32_t>(found->second), named.box, body.pose});
        Streamed& collider = start.colliders[found->second];
        if (!first) {
            continue;
        }
        if (!isStreamable(*body.collider)) {
            return fail(ErrorCode::kUnsupported, quotedPath(named.coarse->file) +
                                                     ": streamed colliders must have exactly one map of "
                                                     "patches; bake the level again");
        }
        collider.body = start.planned.size() - 1;
        collider.texels = static_cast<std::size_t>(named.gpu_bytes / kTexelSize);
        collider.coarse = *body.collider;
        collider.coarse.maps[0].texels.resize(kTexelSize);
        collider.coarse.maps[0].texels.shrink_to_fit();
        start.texels += collider.texels;
    }
    return start;
}

}  // namespace

struct WorldStream::State {
    WorldTextures textures;
    StreamPlan plan;
    std::vector<std::size_t> planned;  // index into the plan for each body, or kNone
    TexelRanges ranges;
    std::unique_ptr<ColliderSource> source;
    StreamOptions options;
    std::vector<Streamed> colliders;         // of the world
    std::vector<std::string> names;          // names of their files
    std::uint64_t coarse_bytes = 0;          // of all permanently resident texels
    std::size_t room = 0;                    // texels
    std::size_t spare = 0;                   // texels reserved against fragmentation
    std::vector<std::uint32_t> wanted = {};  // wanted colliders that fit together, most urgent first
    std::uint64_t choices = 0;
    std::uint64_t era = 0;  // changes if the wanted set changes or a collider is evicted
    std::deque<Upload> arrived = {};
    std::size_t under_way = 0;  // requested and not yet in `arrived`
    std::uint64_t uploaded = 0;
    std::vector<std::string> warnings = {};

    void choose();
    void request();
    void take(ColliderSource::Arrival arrival);
    void markFailed(std::size_t collider, const std::string& warning);
    /// Returns whether the collider's texels fit if all unwanted colliders are evicted.
    [[nodiscard]] bool hasRoom(const Streamed& collider) const;
    /// Allocates a range for the collider's texels. Evicts unwanted colliders, the least recently wanted first.
    Result<bool> makeRoom(Streamed& collider);
    /// \param bytes  maximum to upload.
    Result<void> upload(std::uint64_t bytes);
    void finishUpload();
};

void WorldStream::State::choose() {
    ++choices;
    // Resident and pending colliders count as slightly nearer; otherwise equally distant colliders would alternate.
    std::vector<std::pair<float, std::uint32_t>> order;
    for (const std::uint32_t i : plan.wanted()) {
        const bool here = colliders[i].present || colliders[i].requested;
        order.emplace_back((here ? kResidentFactor : 1.0F) * plan.nearest(i), i);
    }
    std::sort(order.begin(), order.end());
    const std::vector<std::uint32_t> before = std::exchange(wanted, {});
    std::size_t texels = 0;
    for (const auto& [distance, i] : order) {
        Streamed& collider = colliders[i];
        if (!collider.failed && (texels == 0 || texels + collider.texels + spare <= room)) {
            texels += collider.texels;
            collider.last_wanted = choices;
            wanted.push_back(i);
        }
    }
    era += wanted != before ? 1 : 0;
}

bool WorldStream::State::hasRoom(const Streamed& collider) const {
    TexelRanges left = ranges;
    for (const Streamed& other : colliders) {
        if (other.present && other.last_wanted != choices) {
            left.give(*other.place, other.texels);
        }
    }
    return left.take(collider.texels).has_value();
}

void WorldStream::State::request() {
    for (const std::uint32_t i : wanted) {
        if (under_way + arrived.size() >= options.under_way) {
            return;
        }
        Streamed& collider = colliders[i];
        if (collider.present || collider.requested || collider.failed || collider.refused == era) {
            continue;
        }
        if (!hasRoom(collider)) {
            collider.refused = era;
        } else {
            collider.requested = true;
            ++under_way;
            source->request(i);
        }
    }
}

void WorldStream::State::markFailed(std::size_t index, const std::string& warning) {
    colliders[index].failed = true;
    colliders[index].requested = false;
    warnings.push_back(warning + "; its coarse collider remains in use");
}

void WorldStream::State::take(ColliderSource::Arrival arrival) {
    --under_way;
    if (!arrival.loaded) {
        markFailed(arrival.collider, arrival.loaded.error().message);
    } else if (!isStreamable(*arrival.loaded) ||
               arrival.loaded->texelBytes() != kTexelSize * colliders[arrival.collider].texels) {
        markFailed(arrival.collider, names[arrival.collider] + " is not the collider named by the world");
    } else {
        arrived.push_back({arrival.collider, *std::move(arrival.loaded)});
    }
}

Result<bool> WorldStream::State::makeRoom(Streamed& collider) {
    if (!hasRoom(collider)) {
        collider.refused = era;
        return false;
    }
    while (!(collider.place = ranges.take(collider.texels))) {
        Streamed* oldest = nullptr;
        for (Streamed& other : colliders) {
            if (other.present && other.last_wanted != choices &&
                (oldest == nullptr || other.last_wanted < oldest->last_wanted)) {
                oldest = &other;
            }
        }
        RELIEF_TRY(textures.exchange(oldest->body, oldest->coarse, std::nullopt));
        ranges.give(*oldest->place, oldest->texels);
        oldest->place.reset();
        oldest->present = false;
        ++era;
    }
    return true;
}

Result<void> WorldStream::State::upload(std::uint64_t bytes) {
    auto texels = static_cast<std::size_t>(
        std::clamp<std::uint64_t>(bytes / kTexelSize, 1, std::numeric_limits<std::size_t>::max()));
    while (texels > 0 && !arrived.empty()) {
        Upload& first = arrived.front();
        Streamed& collider = colliders[first.collider];
        if (!collider.place && !(collider.last_wanted == choices && RELIEF_TRY(makeRoom(collider)))) {
            collider.requested = false;
            source->release(std::move(first.loaded));
            arrived.pop_front();
            continue;
        }
        std::size_t count = std::min(texels, collider.texels - first.done);
        if (const std::size_t beyond = (*collider.place + first.done + count) % textures.rowTexels();
            count < collider.texels - first.done && beyond < count) {
            count -= beyond;  // end at the end of a row: this needs one GL copy instead of two
        }
        textures.upload(
            *collider.place + first.done,
            std::span(first.loaded.maps[0].texels).subspan(kTexelSize * first.done, kTexelSize * count));
        first.done += count;
        texels -= count;
        uploaded += kTexelSize * count;
        if (first.done < collider.texels) {
            return {};
        }
        finishUpload();
    }
    return {};
}

void WorldStream::State::finishUpload() {
    Upload first = std::move(arrived.front());
    arrived.pop_front();
    Streamed& collider = colliders[first.collider];
    collider.requested = false;
    if (const Result<void> exchanged = textures.exchange(collider.body, first.loaded, collider.place);
        !exchanged) {
        ranges.give(*collider.place, collider.texels);
        collider.place.reset();
        markFailed(first.collider, names[first.collider] + ": " + exchanged.error().message);
    } else {
        collider.present = true;
    }
    source->release(std::move(first.loaded));
}

WorldStream::WorldStream(std::unique_ptr<State> state) : state_(std::move(state)) {}
WorldStream::~WorldStream() = default;

Result<std::unique_ptr<WorldStream>> WorldStream::create(const World& world,
                                                         std::span<const ColliderBody> bodies,
                                                         std::span<const Collider* const> coarse,
                                                         std::unique_ptr<ColliderSource> source,
                                                         const StreamOptions& options) {
    auto [colliders, plan, planned, coarse_bytes, texels] = RELIEF_TRY(layOut(world, bodies, coarse));
    std::vector<std::string> names;
    for (const WorldCollider& collider : world.colliders) {
        names.push_back(quotedPath(collider.file));
    }
    if (coarse_bytes > options.gpu_bytes) {
        return fail(ErrorCode::kLimit, "the resident colliders of this world need " +
                                           std::to_string(coarse_bytes) +
                                           " bytes of GPU memory, more than the limit of " +
                                           std::to_string(options.gpu_bytes) + "; raise the limit");
    }
    RELIEF_TRY(checkContext());
    const std::uint64_t most =
        std::max<std::uint64_t>(WorldTextures::maxTexels(), coarse_bytes / kTexelSize) -
        coarse_bytes / kTexelSize;
    const auto room = static_cast<std::size_t>(
        std::min({std::uint64_t{texels}, (options.gpu_bytes - coarse_bytes) / kTexelSize, most}));
    auto textures = RELIEF_TRY(WorldTextures::create(bodies, room));
    const std::size_t first = textures.room();
    auto state = std::make_unique<State>(
        State{.textures = std::move(textures),
              .plan = StreamPlan(std::move(plan), colliders.size()),
              .planned = std::move(planned),
              .ranges = TexelRanges(first, room),
              .source = std::move(source),
              .options = options,
              .colliders = std::move(colliders),
              .names = std::move(names),
              .coarse_bytes = coarse_bytes,
              .room = room,
              // Without a reserve, the gaps between ranges would be too short for the last colliders.
              .spare = room < texels ? room / 8 : 0});
    for (std::size_t i = 0; i < state->colliders.size(); ++i) {
        if (state->colliders[i].texels > room) {
            state->markFailed(
                i, state->names[i] + " needs " + std::to_string(kTexelSize * state->colliders[i].texels) +
                       " bytes of GPU memory; the maximum is " + std::to_string(kTexelSize * room));
        }
    }
    return std::unique_ptr<WorldStream>(new WorldStream(std::move(state)));
}

Result<std::unique_ptr<WorldStream>> WorldStream::open(const std::filesystem::path& path,
                                                       const StreamOptions& options,
                                                       const ContainerLimits& limits) {
    return open(RELIEF_TRY(loadWorld(path, limits, WorldDetail::kCoarse)), path, options, limits);
}

Result<std::unique_ptr<WorldStream>> WorldStream::open(const LoadedWorld& coarse,
                                                       const std::filesystem::path& path,
                                                       const StreamOptions& options,
                                                       const ContainerLimits& limits) {
    std::vector<const Collider*> colliders;
    for (const Collider& collider : coarse.colliders) {
        colliders.push_back(&collider);
    }
    auto source = RELIEF_TRY(makeFileSource(coarse.world, path.parent_path(), limits));
    return withPrefix(quotedPath(path),
                      create(coarse.world, worldBodies(coarse), colliders, std::move(source), options));
}

const WorldTextures& WorldStream::textures() const {
    return state_->textures;
}

WorldTextures& WorldStream::textures() {
    return state_->textures;
}

void WorldStream::setPoses(std::span<const Pose> poses) {
    state_->textures.setPoses(poses);
    for (std::size_t i = 0; i < std::min(poses.size(), state_->planned.size()); ++i) {
        if (state_->planned[i] != kNone) {
            state_->plan.setPose(state_->planned[i], poses[i]);
        }
    }
}

Result<void> WorldStream::update(std::span<const PointOfInterest> points) {
    RELIEF_TRY(checkPoints(points));
    State& state = *state_;
    if (state.plan.measureSome(points, kPairsPerUpdate)) {
        state.choose();
    }
    while (std::optional<ColliderSource::Arrival> arrival = state.source->take()) {
        state.take(*std::move(arrival));
    }
    state.request();
    return state.upload(state.options.upload_bytes);
}

Result<void> WorldStream::finish(std::span<const PointOfInterest> points) {
    RELIEF_TRY(checkPoints(points));
    State& state = *state_;
    state.plan.measureAll(points);
    state.choose();
    while (true) {
        RELIEF_TRY(state.upload(std::numeric_limits<std::uint64_t>::max()));
        state.request();
        std::optional<ColliderSource::Arrival> arrival = state.source->wait();
        if (!arrival) {
            return {};
        }
        state.take(*std::move(arrival));
    }
}

std::vector<std::string> WorldStream::takeWarnings() {
    return std::exchange(state_->warnings, {});
}

StreamCounts WorldStream::counts() const {
    StreamCounts counts{.wanted = state_->plan.wanted().size(),
                        .gpu_bytes = state_->coarse_bytes,
                        .uploaded = state_->uploaded};
    for (const std::uint32_t i : state_->plan.wanted()) {
        counts.present += state_->colliders[i].present ? 1 : 0;
    }
    for (const Streamed& collider : state_->colliders) {
        counts.failed += collider.failed ? 1 : 0;
        counts.gpu_bytes += collider.place ? kTexelSize * collider.texels : 0;
    }
    return counts;
}

}  // namespace relief
