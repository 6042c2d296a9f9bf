// Tests of an acceleration that a program prescribes to the leader of a platoon.
#include <gtest/gtest.h>

#include "support/track.h"

namespace stopline {
namespace {

using testing_support::Track;

Track platoon() {
    Track track(testing_support::TrackPlan{});
    track.place_platoon(0, 300.0, 10.0, 2);
    return track;
}

TEST(PrescribedAcceleration, LimitsTheLeader) {
    for (const bool scalar : {false, true}) {
        testing_support::TrackPlan plan;
        plan.scalar = scalar;
        Track track(plan);
        track.place_platoon(0, 300.0, 10.0, 2);
        track.run(5.0);
        track.simulation().prescribe({track.vehicle(0, 0).id, -1.0});
        const double before_mps = track.vehicle(0, 0).speed_mps;
        track.run(3.0);
        EXPECT_NEAR(track.vehicle(0, 0).acceleration_mps2, -1.0, 0.05);
        EXPECT_NEAR(track.vehicle(0, 0).speed_mps, before_mps - 3.0, 0.5);
        track.simulation().prescribe({});
        track.run(3.0);
        EXPECT_GT(track.vehicle(0, 0).acceleration_mps2, 0.3);
    }
}

TEST(PrescribedAcceleration, DoesNotMakeADriverAccelerateMore) {
    Track free = platoon();
    Track prescribed = platoon();
    prescribed.simulation().prescribe({prescribed.vehicle(0, 0).id, 5.0});
    free.run(10.0);
    prescribed.run(10.0);
    EXPECT_EQ(free.simulation().state_hash(), prescribed.simulation().state_hash());
}

TEST(PrescribedAcceleration, AppliesOnlyToTheFirstVehicleOfALane) {
    Track free = platoon();
    Track prescribed = platoon();
    prescribed.simulation().prescribe({prescribed.vehicle(0, 1).id, -3.0});
    free.run(10.0);
    prescribed.run(10.0);
    EXPECT_EQ(free.simulation().state_hash(), prescribed.simulation().state_hash());
}

}  // namespace
}  // namespace stopline
