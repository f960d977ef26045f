#include "bake/prefer.h"

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

}  // namespace relief
