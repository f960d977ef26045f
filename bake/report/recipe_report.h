// SPDX-License-Identifier: Apache-2.0
// Reports of a recipe run: events for programs during the run, and a summary for people and programs.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bake/recipe/recipe_run.h"
#include "bake/report/bake_report.h"
#include "formats/base/descriptor.h"

namespace relief {

struct RecipeCounts {
    std::array<std::size_t, kWordsOf<AssetState>.size()> of_state{};
    std::uint64_t bytes = 0;  ///< total of all outputs that are baked or up to date

    [[nodiscard]] std::size_t of(AssetState state) const { return of_state[static_cast<std::size_t>(state)]; }
    [[nodiscard]] std::size_t all() const;
};
[[nodiscard]] RecipeCounts countAssets(const std::vector<AssetResult>& assets);

/// Returns "baked, 255 kB, 0.05 % wrong, 0.8 s".
[[nodiscard]] std::string bakedText(const AssetResult& asset);

/// Returns "12 assets: 3 baked, 8 up to date, 1 failed; 1.2 MB; 4.5 s", or "12 assets up to date".
[[nodiscard]] std::string recipeSummary(const RecipeCounts& counts, double ms);

// --- The same data as fields.

/// The fields of an asset depend on its state.
struct AssetReport {
    const AssetResult& asset = kNone<AssetResult>;
    bool event = false;  ///< part of an event: omits `key` unless the asset is baked or up to date

    [[nodiscard]] static std::vector<AssetReport> kinds();
};

void fields(FieldVisitor& visit, const AssetReport& report);

void fields(FieldVisitor& visit, const RecipeCounts& counts);

/// The report of `relief bake --recipe --json`.
struct RecipeJson {
    std::string recipe;
    std::string output;
    std::optional<Shard> shard;
    RecipeCounts counts = {};
    double ms = 0.0;
    std::vector<AssetReport> assets = {};
};

void fields(FieldVisitor& visit, const RecipeJson& report);

// --- Events.

struct RecipeStart {
    std::string recipe;
    std::size_t assets = 0;
    std::optional<Shard> shard;
    unsigned jobs = 1;
};

void fields(FieldVisitor& visit, const RecipeStart& start);

struct AssetEvent {
    AssetReport asset = {};

    [[nodiscard]] static std::vector<AssetEvent> kinds();
};

void fields(FieldVisitor& visit, const AssetEvent& event);

struct RecipeEnd {
    RecipeCounts counts = {};
    double ms = 0.0;
    int signal = 0;  ///< 0: no signal
};

void fields(FieldVisitor& visit, const RecipeEnd& end);

using RecipeEvent = std::variant<RecipeStart, AssetEvent, RecipeEnd>;

/// Writes events as lines of JSON, immediately.
class RecipeEvents {
  public:
    /// \param path  truncated if it is the log of an earlier run; "-": standard output
    /// Errors: kIo; kUsage (the file is not a log, and its contents would be lost).
    [[nodiscard]] Result<void> open(const std::string& path);
    /// Does nothing before open(). Errors are reported by finish().
    void write(const RecipeEvent& event);
    /// Errors: kIo (an event could not be written).
    [[nodiscard]] Result<void> finish() const;

  private:
    std::string path_;
    Descriptor file_;
    int fd_ = -1;  ///< of file_, or standard output
    int error_ = 0;
};

/// The warnings of one of many bakes.
struct OwnerWarnings {
    std::string owner;  ///< name of the bake in the line, such as its output
    std::string mesh;   ///< name of the mesh, removed from the start of warnings
    std::span<const std::string> warnings;
};
/// Groups equal warnings into one line each, in the order of their first occurrence.
/// \param owners  plural noun for the owners, such as "assets"
/// \param join_numbers  whether warnings that differ only in their numbers count as equal
[[nodiscard]] std::vector<std::string> warningLines(std::span<const OwnerWarnings> all,
                                                    std::string_view owners, bool join_numbers);
/// Groups the warnings of assets: "2 assets (a.relief, b.relief): it is skinned". All warnings about a missing unit
/// form one group, with the size of the first asset.
[[nodiscard]] std::vector<std::string> warningLines(const std::vector<AssetResult>& assets);

}  // namespace relief
