#include "bake/plan/prefer.h"

namespace relief {

const char* preferName(Prefer prefer) {
    switch (prefer) {
        case Prefer::kNeither:
            return "neither";
        case Prefer::kInside:
            return "inside";
        case Prefer::kOutside:
            return "outside";
    }
    return "unknown";
}

const char* qualityName(Quality quality) {
    switch (quality) {
        case Quality::kFast:
            return "fast";
        case Quality::kNormal:
            return "normal";
        case Quality::kBest:
            return "best";
    }
    return "unknown";
}

}  // namespace relief
