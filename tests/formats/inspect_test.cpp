// SPDX-License-Identifier: Apache-2.0
// `relief check FILE`: results for sound files, and for the remaining maps of damaged files. container_hostile_test has
// a file for every issue.
#include "formats/inspect.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "formats/container.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"

namespace relief {
namespace {

using Bytes = std::vector<std::byte>;
using test::written;

Inspection inspected(const Bytes& bytes) {
    const Result<Inspection> inspection = inspectContainer(bytes);
    EXPECT_TRUE(inspection);
    return inspection.value_or(Inspection{});
}

std::string listed(const Inspection& inspection) {
    std::string text;
    for (const Issue& issue : inspection.issues) {
        text += issue.id() + " map " + std::to_string(issue.map) + ": " + issue.message + "\n";
    }
    return text;
}

std::vector<PartState> statesOf(const Inspection& inspection) {
    std::vector<PartState> states;
    for (const MapInspection& map : inspection.maps) {
        states.push_back(map.state);
    }
    return states;
}

TEST(Inspect, SoundFilesHaveNoIssues) {
    for (const int level : {0, 3}) {
        for (const Collider& collider : {test::oneMapOfEveryFormat(), test::readmeExample()}) {
            const Inspection inspection = inspected(written(collider, level));
            EXPECT_TRUE(inspection.issues.empty()) << listed(inspection);
            EXPECT_EQ(inspection.header, PartState::kSound);
            EXPECT_EQ(inspection.metadata, PartState::kSound);
            EXPECT_EQ(statesOf(inspection), std::vector(collider.maps.size(), PartState::kSound));
        }
    }
    const Inspection one_texel = inspected(written(test::readmeExample()));
    EXPECT_DOUBLE_EQ(one_texel.maps[0].coverage.value(), 1.0 / 9.0);
}

TEST(Inspect, ListsTheIntactMapsOfADamagedFile) {
    Collider collider = test::readmeExample();
    collider.maps.resize(3, collider.maps[0]);
    const Bytes good = written(collider);
    const ContainerInfo info = required(readContainerInfo(good));
    const auto at = [&](std::size_t map) { return static_cast<std::size_t>(info.payloads[map].offset); };
    using enum PartState;

    Bytes bytes = good;
    bytes[at(1) + 7] ^= std::byte{4};
    Inspection inspection = inspected(bytes);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kDamaged, kSound})) << listed(inspection);
    EXPECT_EQ(inspection.metadata, kSound);
    ASSERT_EQ(inspection.issues.size(), 1U) << listed(inspection);
    EXPECT_EQ(inspection.issues[0].map, 1);
    EXPECT_EQ(inspection.issues[0].offset, at(1));

    // The last map is truncated.
    bytes.assign(good.begin(), good.begin() + static_cast<long>(at(2) + 1));
    inspection = inspected(bytes);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kSound, kUnreadable})) << listed(inspection);
    EXPECT_EQ(inspection.header, kSound);

    // A damaged header does not invalidate metadata whose own checksum matches.
    bytes = good;
    bytes[57] ^= std::byte{4};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.header, kDamaged);
    EXPECT_EQ(inspection.metadata, kSound);
    EXPECT_EQ(statesOf(inspection), (std::vector{kSound, kSound, kSound})) << listed(inspection);

    // Damaged metadata: the payloads are intact, but cannot be assigned to maps.
    bytes = good;
    bytes[48] ^= std::byte{4};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.metadata, kDamaged);
    EXPECT_EQ(statesOf(inspection), (std::vector{kUnverified, kUnverified, kUnverified}))
        << listed(inspection);

    // Two faults give two issues.
    bytes = good;
    bytes[at(0)] ^= std::byte{1};
    bytes[at(2)] ^= std::byte{1};
    inspection = inspected(bytes);
    EXPECT_EQ(inspection.count(Severity::kError), 2U) << listed(inspection);
    EXPECT_EQ(statesOf(inspection), (std::vector{kDamaged, kSound, kDamaged}));
}

}  // namespace
}  // namespace relief
