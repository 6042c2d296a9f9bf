// An acceleration that a program prescribes to one vehicle, such as the leader of a platoon in an experiment.
#pragma once

namespace stopline {

// The vehicle accelerates at most with `acceleration_mps2`. It accelerates less if its driver wants so. The
// prescription has an effect in full dynamics only, and only while the vehicle is the first one on its lane.
struct PrescribedAcceleration {
    int vehicle = -1;  // id of the vehicle; -1: none
    double acceleration_mps2 = 0.0;
};

}  // namespace stopline
