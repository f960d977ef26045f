// A collider measured against its mesh, as one page to look at: `relief check --html`.
#pragma once

#include <span>
#include <string>

#include "bake/measure/accuracy.h"
#include "bake/measure/part_accuracy.h"
#include "bake/measure/worst_places.h"
#include "bake/report/places_report.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

struct AccuracyPageInput {
    std::string file_name;  ///< of the collider, without its folder
    const Collider& collider;
    const MeshQuery& query;
    const TruthSamples& samples;
    const ColliderAccuracy& accuracy;
    const SurfaceParts& parts;
    const PartsAccuracy& part_accuracy;
    std::span<const WorstPlace> places;
    std::span<const Advice> advice;
};

/// HTML with everything in it: no script, no file and no address but data: URIs. The same input gives the
/// same bytes. Errors: kFailure (a picture).
[[nodiscard]] Result<std::string> accuracyPage(const AccuracyPageInput& input);

}  // namespace relief
