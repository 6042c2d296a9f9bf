#include "sumo_export/vehicle_type.h"

namespace stopline {

void add_vehicle_type(XmlFile& xml, const Model& model, std::size_t policy, const VehicleTypeText& type) {
    // In an initial queue, the gap between two vehicles equals the standstill gap of the policy. SUMO does not insert a
    // vehicle with a gap below minGap, and rounded positions in the file can make the gap slightly smaller. So minGap
    // is reduced by this margin.
    constexpr double kRounding_m = 0.001;
    const SumoFollowing k = model.following[policy].in_sumo();
    const DriverTables& driver = model.driver_of(static_cast<int>(policy)).tables;
    xml.add(
        "    <vType id=\"{}\" carFollowModel=\"{}\" accel=\"{:.4f}\" decel=\"{:.4f}\" tau=\"{:.4f}\" sigma=\"{:.4f}\" "
        "minGap=\"{:.4f}\" length=\"{:.4f}\" maxSpeed=\"70\" speedFactor=\"{:.4f}\" speedDev=\"0\" jmStoplineGap=\"{:.3f}\"{}/>",
        type.id, k.model, k.acceleration_mps2, k.deceleration_mps2, k.time_gap_s, k.dawdling,
        k.standstill_gap_m - kRounding_m, type.length_m, model.speed_factor, driver.stop.margin_m,
        type.changes_lanes ? "" : R"( lcSpeedGain="0" lcKeepRight="0" lcCooperative="0")");
    xml.add("{}\n", k.is_same_model ? "" : " <!-- nearest equivalent of a constant-distance policy -->");
}

}  // namespace stopline
