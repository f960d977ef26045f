#include "bake/report/collider_report.h"

#include <utility>

namespace relief {

InfoReport::InfoReport(std::string name, const Collider& shown, const ContainerInfo& info)
    : file(std::move(name)), collider{shown, info} {
    for (std::size_t i = 0; i < shown.maps.size(); ++i) {
        collider.maps.push_back({i, shown.maps[i], info.payloads[i]});
    }
}

}  // namespace relief
