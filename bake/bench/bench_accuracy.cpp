// relief-accuracy: wrong points per byte of a distance volume, of the paper's maps, and of ours.
// scripts/accuracy.sh runs it on its list of meshes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <glm/vec2.hpp>
#include <nlohmann/json.hpp>
#include <span>

#include "bake/bench/accuracy_summary.h"
#include "bake/bench/distance_volume.h"
#include "bake/import/mesh_import.h"
#include "bake/measure/accuracy.h"
#include "bake/pipeline/bake.h"
#include "bake/plan/view.h"
#include "bake/plan/view_planner.h"
#include "bake/repair/hole_caps.h"
#include "bake/report/accuracy_report.h"
#include "bake/report/points_csv.h"
#include "bake/report/report.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/tool/json_text.h"

namespace relief {
namespace {

using Json = nlohmann::ordered_json;

class Stopwatch {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// --- who takes part ---

/// Three front-back maps along the axes on tight boxes, texels as square and as equal in size as whole
/// numbers allow, as many as fit.
Result<std::vector<MapSpec>> threeMaps(const TriangleMesh& mesh, std::uint64_t bytes) {
    std::vector<MapSpec> specs(3);
    glm::dvec2 extent[3];
    for (int axis = 0; axis < 3; ++axis) {
        MapSpec& spec = specs[static_cast<std::size_t>(axis)];
        spec.format = MapFormat::kFrontBackHalf;
        spec.decode = Decode::kProjected;
        spec.direction = glm::vec3(0.0F);
        spec.direction[axis] = -1.0F;
        spec.width = spec.height = kMapSizeMin;
        const View view = RELIEF_TRY(makeView(spec, mesh));
        // One texel between the borders: the tight volume is a third of the texture.
        extent[axis] = glm::dvec2(view.object_per_map.x, view.object_per_map.y) / 3.0;
    }
    const auto resize = [&](double texel) {
        std::uint64_t total = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            const auto side = [&](double length) {
                const double texels = std::ceil(length / texel * (1.0 - 1e-9)) + 2.0;
                return static_cast<std::uint32_t>(std::min<double>(texels, kMapSizeMax));
            };
            specs[i].width = side(extent[i].x);
            specs[i].height = side(extent[i].y);
            total += std::uint64_t{specs[i].width} * specs[i].height * texelSize(specs[i].format);
        }
        return total <= bytes;
    };
    double large = static_cast<double>(mesh.bounds.longestSide()) * 2.0;
    if (!resize(large)) {
        return fail(ErrorCode::kUsage, "--budget is too small for three maps; give it more bytes");
    }
    double small = 0.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (small + large);
        (resize(middle) ? large : small) = middle;
    }
    (void)resize(large);
    return specs;
}

/// The paper's projected depth in the paper's front-back format.
Result<Baked> bakePaper(const TriangleMesh& mesh, std::uint64_t bytes) {
    std::vector<MapSpec> specs = RELIEF_TRY(threeMaps(mesh, bytes));
    BakeOptions options;
    options.maps = std::move(specs);
    return bake(mesh, options);
}

/// What `relief bake --budget` makes.
Result<Baked> bakeOurs(const TriangleMesh& open_mesh, std::uint64_t bytes) {
    const TriangleMesh closed = RELIEF_TRY(closeHoles(open_mesh));
    const TriangleMesh& mesh = closed;
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
    PlanOptions plan_options;
    plan_options.budget_bytes = bytes;
    const Plan plan = RELIEF_TRY(planViews(mesh, query, plan_options));
    BakeOptions options;
    options.maps = specsOf(plan);
    return bake(mesh, options);
}

// --- measuring ---

/// One mesh, budget and method.
struct Entry {
    std::string mesh;
    bool closed = false;
    std::uint64_t budget = 0;
    std::string method;  ///< "volume", "paper" or "ours"
    std::string what;    ///< lattice or maps
    std::size_t maps = 0;
    std::uint64_t bytes = 0;
    double build_seconds = 0.0;  ///< of maps: acceleration structure, plan, rays and fit
    Json accuracy;               ///< of jsonFieldAccuracy or jsonColliderAccuracy

    [[nodiscard]] double number(const char* group, const char* name) const {
        return accuracy.at(group).at(name).get<double>();
    }
    [[nodiscard]] double wrong() const { return number("near", "wrong_percent"); }
};

Json toJson(const Entry& entry) {
    return {{"mesh", entry.mesh},        {"closed", entry.closed},
            {"budget", entry.budget},    {"method", entry.method},
            {"what", entry.what},        {"maps", entry.maps},
            {"bytes", entry.bytes},      {"build_seconds", entry.build_seconds},
            {"accuracy", entry.accuracy}};
}

/// The best of all ways to place and to quantise the volume.
Entry measureVolume(const MeshQuery& query, const TruthSamples& samples, std::uint64_t budget) {
    Entry entry;
    entry.method = "volume";
    // Four standard deviations hold all but 6 in 100 000 of the points near the surface.
    const double reach = 4.0 * samples.options.sigma_share * samples.longest_side;
    std::optional<FieldAccuracy> best;
    for (const LatticeFit fit : {LatticeFit::kCentered, LatticeFit::kCorner, LatticeFit::kStretched}) {
        const Stopwatch watch;
        const DistanceGrid grid =
            sampleDistances(query, makeLattice(query.mesh().bounds, budget / sizeof(std::int16_t), fit));
        const double seconds = watch.seconds();
        for (const bool band : {false, true}) {
            const DistanceVolume volume(
                grid, band ? DistanceVolume::bandRange(grid, reach) : DistanceVolume::fullRange(grid));
            const FieldAccuracy accuracy = measureField(samples, fieldOf(volume));
            if (!best || accuracy.near.total() < best->near.total()) {
                best = accuracy;
                const glm::uvec3 n = grid.lattice.nodes;
                entry.what = std::to_string(n.x) + "x" + std::to_string(n.y) + "x" + std::to_string(n.z) +
                             (fit == LatticeFit::kCentered ? " centred"
                              : fit == LatticeFit::kCorner ? " from a corner"
                                                           : " stretched") +
                             (band ? ", band" : "");
                entry.bytes = volume.bytes();
                entry.build_seconds = seconds;
            }
        }
    }
    entry.accuracy = jsonFieldAccuracy(*best, samples.longest_side);
    return entry;
}

Result<Entry> measureMaps(const MeshQuery& query, const TruthSamples& samples, const std::string& method,
                          std::uint64_t budget) {
    const Stopwatch watch;
    const Baked baked =
        RELIEF_TRY(method == "paper" ? bakePaper(query.mesh(), budget) : bakeOurs(query.mesh(), budget));
    Entry entry;
    entry.build_seconds = watch.seconds();
    entry.method = method;
    const ColliderAccuracy accuracy = measureCollider(samples, query, baked.collider);
    for (const DepthMap& map : baked.collider.maps) {
        entry.what += (entry.what.empty() ? "" : " ") + std::to_string(map.width) + "x" +
                      std::to_string(map.height) + (map.faceCount() == 6 ? "x6" : "");
    }
    entry.maps = baked.collider.maps.size();
    entry.bytes = accuracy.gpu_bytes;
    entry.accuracy = jsonColliderAccuracy(accuracy, samples.longest_side);
    return entry;
}

/// Measured volumes, kept between runs in a file for those who work on the maps: the volume's figures change
/// with the key alone.
class Cache {
  public:
    explicit Cache(std::string path) : path_(std::move(path)) {
        if (path_.empty()) {
            return;
        }
        if (const Result<std::vector<std::byte>> bytes = readFile(path_); bytes) {
            const auto* first = reinterpret_cast<const char*>(bytes->data());
            json_ = Json::parse(first, first + bytes->size(), nullptr, false);
        }
        if (!json_.is_object()) {
            json_ = Json::object();  // no file yet, or none of ours
        }
    }

    static std::string key(const TriangleMesh& mesh, std::uint64_t budget, const AccuracyOptions& options) {
        return "volume " + std::to_string(kDistanceVolumeVersion) + ", mesh " + mesh.content_hash + ", " +
               std::to_string(budget) + " bytes, " + std::to_string(options.samples) + " samples, seed " +
               std::to_string(options.seed);
    }

    [[nodiscard]] std::optional<Entry> find(const std::string& key) const {
        if (!json_.contains(key)) {
            return std::nullopt;
        }
        try {
            const Json& json = json_[key];
            Entry entry;
            entry.method = "volume";
            entry.what = json.at("what");
            entry.bytes = json.at("bytes");
            entry.build_seconds = json.at("build_seconds");
            entry.accuracy = json.at("accuracy");
            // Everything that the tables read, so that a file of another version is measured again.
            for (const char* name : {"wrong_percent", "false_inside_percent", "false_outside_percent"}) {
                (void)entry.number("near", name);
                (void)entry.number("uniform", name);
            }
            (void)entry.number("distance_error", "mean_percent");
            (void)entry.number("distance_error", "p99_percent");
            (void)entry.number("normal_error_degrees", "mean");
            (void)entry.accuracy.at("far_percent").get<double>();
            (void)entry.accuracy.at("unknown_percent").get<double>();
            return entry;
        } catch (const Json::exception&) {
            return std::nullopt;
        }
    }

    [[nodiscard]] Result<void> add(const std::string& key, const Entry& entry) {
        if (path_.empty()) {
            return {};
        }
        json_[key] = toJson(entry);
        const std::string text = json_.dump(1) + "\n";
        return writeFile(path_, std::as_bytes(std::span(text)));
    }

  private:
    std::string path_;
    Json json_ = Json::object();
};

// --- the table ---

std::string fixedText(double value, int digits) {
    char text[32];
    std::snprintf(text, sizeof(text), "%.*f", digits, value);
    return text;
}

using Rows = std::vector<std::vector<std::string>>;

/// GitHub's tables; a heading that ends in '>' goes right, as in table().
std::string markdown(const Rows& rows) {
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::string rule = "|";
        text += "|";
        for (const std::string& cell : rows[i]) {
            const bool right = i == 0 && cell.ends_with('>');
            text += " " + (right ? cell.substr(0, cell.size() - 1) : cell) + " |";
            rule += right ? " ---: |" : " --- |";
        }
        text += "\n" + (i == 0 ? rule + "\n" : "");
    }
    return text;
}

/// All of every entry, one a line.
Rows detailRows(const std::vector<Entry>& entries) {
    Rows rows = {{"mesh", "budget>", "method", "wrong %>", "in>", "out>", "box %>", "dist mean %>", "p99 %>",
                  "normal>", "unseen %>", "bytes>", "s>", "what"}};
    for (const Entry& entry : entries) {
        rows.push_back({entry.mesh, budgetText(entry.budget), entry.method, fixedText(entry.wrong(), 3),
                        fixedText(entry.number("near", "false_inside_percent"), 3),
                        fixedText(entry.number("near", "false_outside_percent"), 3),
                        fixedText(entry.number("uniform", "wrong_percent"), 3),
                        fixedText(entry.number("distance_error", "mean_percent"), 4),
                        fixedText(entry.number("distance_error", "p99_percent"), 4),
                        fixedText(entry.number("normal_error_degrees", "mean"), 2),
                        entry.accuracy.contains("unseen_area_percent")
                            ? fixedText(entry.accuracy["unseen_area_percent"], 2)
                            : "-",
                        std::to_string(entry.bytes), fixedText(entry.build_seconds, 2), entry.what});
    }
    return rows;
}

/// The entries of one mesh and budget side by side; null where a method was not measured.
struct Contest {
    const Entry* volume = nullptr;
    const Entry* paper = nullptr;
    const Entry* ours = nullptr;

    [[nodiscard]] const Entry& any() const { return ours ? *ours : paper ? *paper : *volume; }
    [[nodiscard]] std::optional<double> ratio(const Entry* maps, std::uint32_t samples) const {
        return maps && volume ? std::optional(wrongRatio(maps->wrong(), volume->wrong(), samples))
                              : std::nullopt;
    }
};

std::vector<Contest> contestsOf(const std::vector<Entry>& entries) {
    std::vector<Contest> contests;
    for (const Entry& entry : entries) {  // neighbours: they were measured one after the other
        if (contests.empty() || contests.back().any().mesh != entry.mesh ||
            contests.back().any().budget != entry.budget) {
            contests.emplace_back();
        }
        Contest& contest = contests.back();
        (entry.method == "volume"  ? contest.volume
         : entry.method == "paper" ? contest.paper
                                   : contest.ours) = &entry;
    }
    return contests;
}

Rows contestRows(const std::vector<Contest>& contests, std::uint32_t samples) {
    Rows rows = {{"mesh", "budget>", "volume %>", "paper %>", "ours %>", "ours/volume>", "in %>", "out %>",
                  "mean: volume>", "paper>", "ours>", "p99: volume>", "paper>", "ours>", "no distance %>",
                  "bytes>", "maps>", "ms>"}};
    for (const Contest& c : contests) {
        const auto number = [](const Entry* entry, const char* group, const char* name, int digits) {
            return entry ? fixedText(entry->number(group, name), digits) : std::string("-");
        };
        const auto wrong = [&](const Entry* entry) { return number(entry, "near", "wrong_percent", 3); };
        const auto mean = [&](const Entry* e) { return number(e, "distance_error", "mean_percent", 4); };
        const auto p99 = [&](const Entry* e) { return number(e, "distance_error", "p99_percent", 3); };
        const std::optional<double> ratio = c.ratio(c.ours, samples);
        const double no_distance = c.ours ? c.ours->accuracy.at("far_percent").get<double>() +
                                                c.ours->accuracy.at("unknown_percent").get<double>()
                                          : 0.0;
        rows.push_back(
            {c.any().mesh + (c.any().closed ? "" : " (open)"), budgetText(c.any().budget), wrong(c.volume),
             wrong(c.paper), wrong(c.ours), ratio ? fixedText(*ratio, 3) : "-",
             number(c.ours, "near", "false_inside_percent", 3),
             number(c.ours, "near", "false_outside_percent", 3), mean(c.volume), mean(c.paper), mean(c.ours),
             p99(c.volume), p99(c.paper), p99(c.ours), c.ours ? fixedText(no_distance, 2) : "-",
             c.ours ? std::to_string(c.ours->bytes) : "-", c.ours ? std::to_string(c.ours->maps) : "-",
             c.ours ? fixedText(1000.0 * c.ours->build_seconds, 0) : "-"});
    }
    return rows;
}

std::vector<AccuracyRow> summaryRows(const std::vector<Contest>& contests, std::uint32_t samples) {
    std::vector<AccuracyRow> rows;
    for (const Contest& c : contests) {
        rows.push_back({c.any().mesh, c.any().closed, c.any().budget, c.ratio(c.paper, samples),
                        c.ratio(c.ours, samples),
                        c.ours ? std::optional(c.ours->build_seconds) : std::nullopt});
    }
    return rows;
}

/// \param gap  goes between the lines.
std::string legend(const AccuracyOptions& options, const std::string& gap) {
    const std::string lines[] = {
        "%: points near the surface on the wrong side of it; in, out: ours, false inside and false "
        "outside. " +
            std::to_string(options.samples) + " points, seed " + std::to_string(options.seed) + ", " +
            fixedText(100.0 * options.sigma_share, 1) +
            " % of the longest side off the surface (standard deviation).",
        "mean, p99: error of the signed distance at those points, in % of the longest side. Where maps say "
        "outside and no more (infinitely far, or no vote) they have no distance and no error: no distance is "
        "the share of such points in ours.",
        "ms: one bake of ours with acceleration structure, plan, rays and fit. open: computed, some edge has "
        "an "
        "odd number of triangles."};
    std::string text;
    for (const std::string& line : lines) {
        text += (text.empty() ? "" : gap) + line;
    }
    return text + "\n";
}

// --- the program ---

struct Arguments {
    std::vector<std::string> meshes;
    std::vector<std::string> budgets = {"0.25MB", "1MB", "4MB"};
    std::uint32_t samples = AccuracyOptions{}.samples;
    std::uint64_t seed = AccuracyOptions{}.seed;
    std::vector<std::string> methods = {"volume", "paper", "ours"};
    std::vector<std::string> only;  ///< stems of meshes; empty: all
    std::string cache;
    std::string values;
    bool details = false;
    bool markdown = false;
    bool json = false;
};

/// For the cross-check against other tools: what the volume knows of given points, one line for each:
/// x,y,z, the exact signed distance that its nodes are made of, and its own lookup.
Result<void> printValues(const MeshQuery& query, std::uint64_t budget, const std::string& path) {
    const std::vector<std::byte> text = RELIEF_TRY(readFile(path));
    const std::vector<glm::vec3> points =
        RELIEF_TRY(parsePoints({reinterpret_cast<const char*>(text.data()), text.size()}, path));
    const DistanceGrid grid = sampleDistances(
        query, makeLattice(query.mesh().bounds, budget / sizeof(std::int16_t), LatticeFit::kCentered));
    const DistanceVolume volume(grid, DistanceVolume::fullRange(grid));
    std::string out;
    for (const glm::vec3& p : points) {
        const float values[5] = {p.x, p.y, p.z, static_cast<float>(query.signedDistance(p)),
                                 volume.at(p).distance};
        for (int i = 0; i < 5; ++i) {
            appendShortest(out, values[i]);
            out += i == 4 ? '\n' : ',';
        }
    }
    return writeFile("-", std::as_bytes(std::span(out)));
}

Json toJson(const BudgetSummary& summary) {
    const auto orNull = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
    Json above = Json::array();
    for (const NamedValue& mesh : summary.closed_above) {
        above.push_back(mesh.mesh);
    }
    return {{"budget", summary.budget},
            {"meshes", summary.meshes},
            {"ours_over_volume", orNull(summary.our_mean)},
            {"paper_over_volume", orNull(summary.paper_mean)},
            {"target", targetRatio(summary.budget)},
            {"closed_above_volume", above},
            {"slowest_bake_seconds", summary.slowest ? Json(summary.slowest->value) : Json()},
            {"missed", summary.missed}};
}

/// The meshes of the command line that --only names, in the command line's order.
Result<std::vector<std::string>> chosenMeshes(const Arguments& arguments) {
    const auto stem = [](const std::string& path) { return std::filesystem::path(path).stem().string(); };
    for (const std::string& name : arguments.only) {
        if (std::none_of(arguments.meshes.begin(), arguments.meshes.end(),
                         [&](const std::string& path) { return stem(path) == name; })) {
            return fail(ErrorCode::kUsage, "--only has '" + cleanUtf8(name) +
                                               "', but no mesh is called so; --methods chooses among volume, "
                                               "paper and ours");
        }
    }
    std::vector<std::string> chosen;
    for (const std::string& path : arguments.meshes) {
        if (arguments.only.empty() ||
            std::find(arguments.only.begin(), arguments.only.end(), stem(path)) != arguments.only.end()) {
            chosen.push_back(path);
        }
    }
    return chosen;
}

Result<void> run(const Arguments& arguments) {
    const std::vector<std::uint64_t> budgets = RELIEF_TRY(parseBudgets(arguments.budgets));
    const std::vector<std::string> paths = RELIEF_TRY(chosenMeshes(arguments));
    Cache cache(arguments.cache);
    AccuracyOptions options;
    options.samples = arguments.samples;
    options.seed = arguments.seed;
    std::vector<Entry> entries;
    Json mesh_reports = Json::array();
    for (const std::string& path : paths) {
        const Stopwatch watch;
        const TriangleMesh mesh = RELIEF_TRY(importMeshInWorker(path));
        const MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
        if (!arguments.values.empty()) {
            return printValues(query, budgets.front(), arguments.values);
        }
        const TruthSamples samples = sampleTruth(query, options);
        Json mesh_report = jsonSamples(samples);
        mesh_report["mesh"] = mesh.name;
        mesh_report["mesh_hash"] = mesh.content_hash;
        mesh_report["triangles"] = mesh.triangles.size();
        mesh_report["watertight"] = query.watertight();
        mesh_reports.push_back(std::move(mesh_report));
        for (const std::uint64_t budget : budgets) {
            for (const std::string& method : arguments.methods) {
                Entry entry;
                if (method == "volume") {
                    const std::string key = Cache::key(mesh, budget, options);
                    if (std::optional<Entry> known = cache.find(key)) {
                        entry = std::move(*known);
                    } else {
                        entry = measureVolume(query, samples, budget);
                        RELIEF_TRY(cache.add(key, entry));
                    }
                } else {
                    Entry measured = RELIEF_TRY(measureMaps(query, samples, method, budget));
                    entry = std::move(measured);
                }
                entry.mesh = mesh.name;
                entry.closed = query.watertight();
                entry.budget = budget;
                entries.push_back(std::move(entry));
            }
        }
        std::fprintf(stderr, "%s: %.1f s\n", mesh.name.c_str(), watch.seconds());
    }
    const std::vector<Contest> contests = contestsOf(entries);
    const std::vector<BudgetSummary> summaries = summarize(summaryRows(contests, options.samples), budgets);
    std::string text;
    if (arguments.json) {
        Json json = {{"meshes", mesh_reports}, {"results", Json::array()}, {"summaries", Json::array()}};
        for (const Entry& entry : entries) {
            json["results"].push_back(toJson(entry));
        }
        for (const BudgetSummary& summary : summaries) {
            json["summaries"].push_back(toJson(summary));
        }
        text = jsonText(json);
    } else {
        const Rows rows = arguments.details ? detailRows(entries) : contestRows(contests, options.samples);
        text = arguments.markdown
                   ? markdown(rows) + "\n" + legend(options, "<br>\n") + "\n```text\n" +
                         summaryText(summaries) + "```\n"
                   : table(rows) + "\n" + legend(options, "\n") + "\n" + summaryText(summaries);
    }
    return writeFile("-", std::as_bytes(std::span(text)));
}

int report(const Error& error) {
    std::fprintf(stderr, "relief-accuracy: error: %s\n", error.message.c_str());
    return static_cast<int>(error.code);
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    using namespace relief;
    CLI::App app("Wrong points per byte: a distance volume, the paper's maps, and ours", "relief-accuracy");
    Arguments arguments;
    app.add_option("mesh", arguments.meshes, "Meshes")->option_text("MESH...")->required();
    app.add_option("--budgets,--budget", arguments.budgets, "Bytes for each collider; default 0.25MB,1MB,4MB")
        ->delimiter(',');
    app.add_option("--samples", arguments.samples, "Points of each kind; default 200000")
        ->check(CLI::Range(1U, 100'000'000U));
    app.add_option("--seed", arguments.seed, "Of the points; default 1");
    app.add_option("--only", arguments.only,
                   "Meshes to measure, by file name without extension; default: all")
        ->delimiter(',');
    app.add_option("--methods", arguments.methods, "volume, paper or ours; default: all")
        ->delimiter(',')
        ->check(CLI::IsMember({"volume", "paper", "ours"}));
    app.add_option("--cache", arguments.cache, "Keep the volume's figures in this file (for development)");
    app.add_option("--values", arguments.values,
                   "Only print x,y,z, exact distance, volume's distance for the points of this CSV file");
    app.add_flag("--details", arguments.details,
                 "One line for each method, with normals, unseen surface and what was built");
    app.add_flag("--markdown", arguments.markdown, "Print tables for a README");
    app.add_flag("--json", arguments.json, "Print JSON");
    CLI11_PARSE(app, argc, argv);
    try {
        const Result<void> done = run(arguments);
        return done ? 0 : report(done.error());
    } catch (const std::exception& e) {
        return report({ErrorCode::kFailure, e.what()});
    }
}
