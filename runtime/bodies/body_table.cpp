// SPDX-License-Identifier: Apache-2.0
#include "runtime/bodies/body_table.h"

#include <algorithm>
#include <cstring>
#include <glm/glm.hpp>
#include <utility>

#include "shaders/bodies/constants.h"

namespace relief {
namespace {

static_assert(sizeof(BlockMap) == kWorldMapTexels * sizeof(glm::uvec4));
static_assert(sizeof(BlockBody) == kWorldBodyTexels * sizeof(glm::uvec4));
static_assert(2 * kGridLevelsMax <= kWorldLevels);

/// Enlargement of boxes, relative to their coordinates, that covers the rounding errors of poses and rows.
constexpr float kSlack = 1e-5F;
/// Cell sizes (BodyGrid::of). Larger for many bodies, to save memory, and for moving bodies, because their grid is
/// uploaded at each step.
constexpr float kCells = 0.25F;
constexpr float kCellsOfMany = 0.5F;
constexpr std::size_t kMany = 16'384;
constexpr float kMovingCells = 1.4F;
/// Body index in a list without entries.
constexpr std::uint32_t kNoBody = 0xffffffffU;
/// Capacity reserved for the grid of moving bodies, relative to its size.
constexpr std::size_t kRoom = 2;

BodyBox boxOf(const TableBody& body, std::uint32_t index, float reach) {
    if (!body.box) {
        return {.body = index, .unbounded = true};
    }
    const Pose& pose = body.pose;
    const glm::mat3 turn = glm::mat3_cast(pose.rotation);
    const glm::vec3 half = 0.5F * pose.scale * glm::max(body.box->size(), glm::vec3(0.0F));
    const glm::vec3 far = pose.scale * glm::max(glm::abs(body.box->min), glm::abs(body.box->max)) +
                          glm::abs(pose.position) + reach;
    return {toWorld(pose, body.box->center()),
            glm::mat3(half.x * turn[0], half.y * turn[1], half.z * turn[2]),
            reach + kSlack * std::max({far.x, far.y, far.z}), index, false};
}

Bounds unionOf(Bounds box, const Bounds& other) {
    box.add(other.min);
    box.add(other.max);
    return box;
}

/// Computes the rows that transform a world point into the body's object space.
void writeRows(const Pose& pose, glm::vec4 (&rows)[3]) {
    const glm::mat3 rotation = glm::mat3_cast(pose.rotation);
    for (int i = 0; i < 3; ++i) {
        // Column i of the rotation is the body's axis i in world space.
        const glm::vec3 row = rotation[i] / pose.scale;
        rows[i] = glm::vec4(row, -glm::dot(row, pose.position));
    }
}

/// Computes the rows that move a point of a body from one pose to another.
void writeMove(const Pose& from, const Pose& to, glm::vec4 (&rows)[3]) {
    // In double, because the two translations nearly cancel.
    const double scale = double{to.scale} / double{from.scale};
    const glm::dmat3 turn =
        scale * glm::mat3_cast(glm::dquat(to.rotation) * glm::conjugate(glm::dquat(from.rotation)));
    const glm::dvec3 shift = glm::dvec3(to.position) - turn * glm::dvec3(from.position);
    for (int i = 0; i < 3; ++i) {
        rows[i] = glm::vec4(glm::dvec4(turn[0][i], turn[1][i], turn[2][i], shift[i]));
    }
}

/// Returns the map of patches of a body in this pose, with world space as its object space. (Other maps have normals in
/// their own space.)
BlockMap placedMap(const BlockMap& map, const Pose& pose) {
    const glm::dmat3 turn = glm::mat3_cast(glm::dquat(pose.rotation));
    const double scale = pose.scale;
    BlockMap placed = map;
    for (int i = 0; i < 3; ++i) {
        placed.row[i] = fromWorld(pose, map.row[i]);
        placed.column[i] = glm::vec4(glm::vec3(scale * (turn * glm::dvec3(map.column[i]))), map.column[i].w);
    }
    placed.object_per_map.x *= pose.scale;
    return placed;
}

}  // namespace

BodyTable::BodyTable(std::vector<BlockMap> maps, std::vector<TableBody> bodies, bool placed)
    : bodies_(std::move(bodies)), moves_(bodies_.size(), 0), settles_(bodies_.size(), 0) {
    first_body_ = kWorldMapTexels * (placed ? bodies_.size() : maps.size());
    words_.resize(first_body_ + kWorldBodyTexels * bodies_.size());
    if (placed) {
        maps_ = std::move(maps);
    } else {
        std::memcpy(words_.data(), maps.data(), maps.size() * sizeof(BlockMap));
    }
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        place(i, bodies_[i].pose);
    }
    arrange();
}

void BodyTable::place(std::size_t index, const Pose& before) {
    const TableBody& body = bodies_[index];
    const bool placed = !maps_.empty();
    if (placed) {
        const BlockMap map = placedMap(maps_[body.first_map], body.pose);
        std::memcpy(&words_[kWorldMapTexels * index], &map, sizeof(map));
    }
    BlockBody block{
        {static_cast<std::int32_t>(placed ? index : body.first_map), static_cast<std::int32_t>(body.maps),
         body.live ? 1 : 0, std::int32_t{1} << body.group},
        {body.pose.scale, body.restitution, 1.0F - body.friction, before == body.pose ? 0.0F : 1.0F},
        {},
        {}};
    writeRows(body.pose, block.row);
    writeMove(before, body.pose, block.move);
    std::memcpy(&words_[first_body_ + kWorldBodyTexels * index], &block, sizeof(block));
}

std::vector<BodyBox> BodyTable::boxes(bool moving) const {
    std::vector<BodyBox> boxes;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        if ((moves_[i] != 0) == moving && bodies_[i].maps > 0) {
            boxes.push_back(boxOf(bodies_[i], static_cast<std::uint32_t>(i), reach_));
        }
    }
    return boxes;
}

std::size_t BodyTable::write(const BodyGrid& grid, std::size_t first, std::vector<glm::ivec4>& levels) {
    const std::size_t end = first + grid.lists.size() + grid.entries.size();
    if (words_.size() < end) {
        words_.resize(end);
    }
    levels.clear();
    for (const BodyGrid::Level& level : grid.levels) {
        levels.emplace_back(__builtin_bit_cast(std::int32_t, level.cells_per_unit),
                            static_cast<std::int32_t>(first + level.first),
                            static_cast<std::int32_t>(level.mask), 0);
    }
    const std::size_t first_entry = first + grid.lists.size();
    for (std::size_t i = 0; i < grid.lists.size(); ++i) {
        // The first entry is stored with the range of the others, which saves most points a fetch.
        const BodyGrid::List& list = grid.lists[i];
        const bool any = list.first < list.end;
        const BodyGrid::Entry entry = any ? grid.entries[list.first] : BodyGrid::Entry{kNoBody, 0};
        words_[first + i] = glm::uvec4(first_entry + list.first + (any ? 1 : 0), first_entry + list.end,
                                       entry.body, entry.hash);
    }
    for (std::size_t i = 0; i < grid.entries.size(); ++i) {
        const BodyGrid::Entry& entry = grid.entries[i];
        words_[first_entry + i] = glm::uvec4(entry.body, entry.hash, 0, 0);
    }
    return end;
}

void BodyTable::arrange() {
    words_.resize(first_body_ + kWorldBodyTexels * bodies_.size());
    const float cells = bodies_.size() <= kMany ? kCells : kCellsOfMany;
    first_moving_ = write(BodyGrid::of(boxes(false), cells), words_.size(), still_levels_);
    const std::size_t end = write(BodyGrid::of(boxes(true), kMovingCells), first_moving_, moving_levels_);
    const std::size_t room = first_moving_ + kRoom * (end - first_moving_);
    log2_width_ = 0;
    while ((std::size_t{1} << (2 * log2_width_)) < room) {
        ++log2_width_;
    }
    const std::size_t width = std::size_t{1} << log2_width_;
    words_.resize((room + width - 1) / width * width);
    resized_ = true;
}

void BodyTable::placeMoving() {
    const std::size_t room = words_.size();
    const std::size_t end = write(BodyGrid::of(boxes(true), kMovingCells), first_moving_, moving_levels_);
    if (end > room) {
        arrange();
    } else {
        changes_.push_back({first_moving_, end});
    }
}

bool BodyTable::setPoses(std::span<const Pose> poses) {
    bool changed = false;
    bool first_move = false;
    bool moved_any = false;
    std::size_t first = bodies_.size();
    std::size_t end = 0;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        const bool moved = i < poses.size() && !(poses[i] == bodies_[i].pose);
        if (!moved && settles_[i] == 0) {
            continue;
        }
        const Pose before = std::exchange(bodies_[i].pose, moved ? poses[i] : bodies_[i].pose);
        place(i, before);
        settles_[i] = moved ? 1 : 0;
        first_move = first_move || (moved && moves_[i] == 0);
        moves_[i] = moved ? 1 : moves_[i];
        moved_any = moved_any || moved;
        changed = changed || settles_[i] != 0;
        first = std::min(first, i);
        end = i + 1;
    }
    if (first < end) {
        changes_.push_back({first_body_ + kWorldBodyTexels * first, first_body_ + kWorldBodyTexels * end});
        if (!maps_.empty()) {
            changes_.push_back({kWorldMapTexels * first, kWorldMapTexels * end});
        }
    }
    if (first_move) {
        arrange();
    } else if (moved_any) {
        placeMoving();
    }
    return changed;
}

bool BodyTable::setMap(std::uint32_t first_map, const BlockMap& map, const std::optional<Bounds>& box) {
    const bool placed = !maps_.empty();
    BlockMap before;
    std::memcpy(&before,
                placed ? static_cast<const void*>(&maps_[first_map]) : &words_[kWorldMapTexels * first_map],
                sizeof(before));
    if (before.info[1] != map.info[1] || before.info[2] != map.info[2]) {
        return false;
    }
    if (placed) {
        maps_[first_map] = map;
    } else {
        std::memcpy(&words_[kWorldMapTexels * first_map], &map, sizeof(map));
        changes_.push_back({kWorldMapTexels * first_map, kWorldMapTexels * (first_map + 1)});
    }
    bool larger = false;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
        TableBody& body = bodies_[i];
        if (body.first_map != first_map || body.maps == 0) {
            continue;
        }
        if (placed) {
            const BlockMap own = placedMap(map, body.pose);
            std::memcpy(&words_[kWorldMapTexels * i], &own, sizeof(own));
            changes_.push_back({kWorldMapTexels * i, kWorldMapTexels * (i + 1)});
        }
        if (body.box && !(box && glm::all(glm::lessThanEqual(body.box->min, box->min)) &&
                          glm::all(glm::greaterThanEqual(body.box->max, box->max)))) {
            body.box = box ? std::optional(unionOf(*body.box, *box)) : std::nullopt;
            larger = true;
        }
    }
    if (larger) {
        arrange();
    }
    return true;
}

void BodyTable::setReach(float radius) {
    if (radius > reach_) {
        reach_ = radius;
        arrange();
    }
}

std::vector<glm::ivec4> BodyTable::block() const {
    std::vector<glm::ivec4> levels = still_levels_;
    levels.insert(levels.end(), moving_levels_.begin(), moving_levels_.end());
    std::vector<glm::ivec4> block{glm::ivec4(log2_width_, static_cast<int>(first_body_),
                                             static_cast<int>(bodies_.size()),
                                             static_cast<int>(levels.size()))};
    levels.resize(kWorldLevels);
    block.insert(block.end(), levels.begin(), levels.end());
    return block;
}

std::vector<BodyTable::Rows> BodyTable::takeChanges() {
    const std::size_t width = std::size_t{1} << log2_width_;
    std::vector<Rows> rows;
    if (std::exchange(resized_, false)) {
        rows.push_back({0, words_.size() / width});
    } else {
        std::sort(changes_.begin(), changes_.end(),
                  [](const Rows& a, const Rows& b) { return a.first < b.first; });
        for (const Rows& texels : changes_) {
            const std::size_t end = (texels.end + width - 1) / width;
            if (!rows.empty() && texels.first / width <= rows.back().end) {
                rows.back().end = std::max(rows.back().end, end);
            } else {
                rows.push_back({texels.first / width, end});
            }
        }
    }
    changes_.clear();
    return rows;
}

}  // namespace relief
