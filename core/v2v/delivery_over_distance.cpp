// A channel whose losses depend on the distance and on the density of vehicles. Each message is lost independently.
#include <algorithm>
#include <array>
#include <iterator>

#include "v2v/channel.h"

namespace stopline {

namespace {

constexpr std::array kDeliveryFields{"delivery"};

// Returns the share at a distance. Beyond both ends of the curve, the share is that at the end.
double share_at(const DeliveryCurve& curve, double distance_m) {
    const auto above = std::upper_bound(curve.distance_m.begin(), curve.distance_m.end(), distance_m);
    if (above == curve.distance_m.begin()) return curve.delivered.front();
    if (above == curve.distance_m.end()) return curve.delivered.back();
    const auto k = static_cast<std::size_t>(std::distance(curve.distance_m.begin(), above));
    const double weight = (distance_m - curve.distance_m[k - 1]) / (curve.distance_m[k] - curve.distance_m[k - 1]);
    return curve.delivered[k - 1] + weight * (curve.delivered[k] - curve.delivered[k - 1]);
}

bool delivery_delivers(const V2vSettings& settings, const V2vMessage& message) {
    const std::vector<DeliveryCurve>& curves = settings.delivery.curves;
    const auto above = std::find_if(curves.begin(), curves.end(), [&](const DeliveryCurve& curve) {
        return curve.density_vpkm > message.density_vpkm;
    });
    double share = share_at(above == curves.end() ? curves.back() : *above, message.distance_m);
    if (above != curves.end() && above != curves.begin()) {
        const DeliveryCurve& below = *std::prev(above);
        const double weight = (message.density_vpkm - below.density_vpkm) / (above->density_vpkm - below.density_vpkm);
        const double share_below = share_at(below, message.distance_m);
        share = share_below + weight * (share - share_below);
    }
    return loss_draw(message.link_key, message.number) < share;
}

std::string delivery_problem(const V2vSettings& settings) {
    const std::vector<DeliveryCurve>& curves = settings.delivery.curves;
    if (curves.empty()) return "delivery is missing: name a file of data/v2v, such as cv2x_4_subchannels";
    const auto falls = [](const DeliveryCurve& a, const DeliveryCurve& b) { return a.density_vpkm >= b.density_vpkm; };
    if (std::adjacent_find(curves.begin(), curves.end(), falls) != curves.end())
        return "the densities of the curves of delivery must rise";
    return {};
}

}  // namespace

extern const V2vChannel kDeliveryChannel;
const V2vChannel kDeliveryChannel{
    "delivery_over_distance", "losses depend on distance and density, by the curves of `delivery`",
    kDeliveryFields,          true,
    delivery_delivers,        delivery_problem};

}  // namespace stopline
