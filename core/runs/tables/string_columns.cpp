// Descriptions of the columns in the tables of stopline-strings.
#include "runs/tables/column_docs.h"

namespace stopline {

namespace {

const ColumnDoc kManoeuvre{"manoeuvre", "", "", "`swing`, `brake` or `start`: the motion of the platoon leader"};
const ColumnDoc kSwingFrequency{"frequency_radps", "rad/s", "", "angular frequency of the swing; empty: no swing"};
const ColumnDoc kDelay{"v2v_delay_s", "s", "", "V2V delay of the drivers"};

std::vector<ColumnDoc> gap_columns(const std::string& vehicles) {
    return {{"gap_error_m", "m", "run", "largest difference between net gap and spacing policy, " + vehicles},
            {"smallest_gap_m", "m", "run", "smallest net gap, " + vehicles},
            {"used_percent", "%", "run", "share of the standstill gap that was used up, " + vehicles},
            {"jerk_mps3", "m/s3", "run",
             "largest change of the acceleration within 0.1 s, divided by 0.1 s, while moving, " + vehicles}};
}

TableDoc summary_table() {
    TableDoc table{
        "strings/summary.csv",
        "One row for each population and manoeuvre of the platoon leader. Of the swings, it has the one with the largest "
        "gain. The gain |Gamma| is the ratio of the amplitudes of a vehicle's and its leader's acceleration.",
        {kPopulationColumn,
         kManoeuvre,
         kSwingFrequency,
         {"vehicles", "veh", "", "vehicles of the platoon, with its leader"},
         {"lag_s", "s", "run", "swings: mean lag of the powertrains of the followers"},
         {"gain", "", "run", "swings: largest measured gain"},
         {"gain_linear", "", "", "largest gain of the linear analysis; empty: mixed population or human drivers"},
         {"linear_frequency_radps", "rad/s", "", "angular frequency of this gain"},
         {"doubling_followers", "veh", "",
          "followers after which an oscillation with `gain` has doubled; empty: never"},
         {"doubling_followers_linear", "veh", "", "the same for `gain_linear`"},
         {"stable_time_gap_s", "s", "",
          "smallest time gap without growth by the linear analysis; empty: constant distance"},
         {"first_growing_position", "", "run",
          "first position whose largest acceleration exceeds that of its leader by 0.1 %; empty: none"},
         {"holding_followers", "veh", "run",
          "followers, from the front, whose largest acceleration is at most twice that of the platoon leader"}}};
    for (ColumnDoc& column : gap_columns("all vehicles")) table.columns.push_back(std::move(column));
    return table;
}

TableDoc positions_table() {
    TableDoc table{"strings/positions.csv",
                   "One row for each population, manoeuvre, swing and position.",
                   {kPopulationColumn,
                    kManoeuvre,
                    kSwingFrequency,
                    {"position", "", "", "0 for the platoon leader, 1 for its first follower"},
                    {"l2_mps2", "m/s2", "run", "root mean square of the acceleration"},
                    {"linf_mps2", "m/s2", "run", "largest absolute acceleration"},
                    {"l2_ratio", "", "run", "`l2_mps2` divided by that of the leader"},
                    {"linf_ratio", "", "run", "`linf_mps2` divided by that of the leader"},
                    {"l2_from_head", "", "run", "`l2_mps2` divided by that of the platoon leader"},
                    {"linf_from_head", "", "run", "`linf_mps2` divided by that of the platoon leader"}}};
    for (ColumnDoc& column : gap_columns("this vehicle")) table.columns.push_back(std::move(column));
    return table;
}

}  // namespace

std::vector<TableDoc> string_table_docs() {
    return {
        summary_table(),
        positions_table(),
        {"strings/gains.csv",
         "One row for each population and swing.",
         {kPopulationColumn,
          kSwingFrequency,
          {"leader_amplitude_mps2", "m/s2", "run", "amplitude of the platoon leader's acceleration"},
          {"gain", "", "run", "measured gain: geometric mean of the positions within the linear range, from 2 on"},
          {"gain_linear", "", "", "gain of the linear analysis; empty: mixed population or human drivers"},
          {"gain_first", "", "run", "measured gain of the first follower"},
          {"gain_largest", "", "run", "largest measured gain of one follower within the linear range"},
          {"gap_error_m", "m", "run", "largest difference between net gap and spacing policy, all vehicles"}}},
        {"strings/sweep.csv",
         "Written with `--sweep`. One row for each V2V delay and time gap.",
         {kPopulationColumn,
          kDelay,
          {"time_gap_s", "s", "", "time gap of the policy"},
          {"gain", "", "run", "largest measured gain of all swings"},
          {"frequency_radps", "rad/s", "", "angular frequency of this gain"},
          {"gain_linear", "", "", "largest gain of the linear analysis"},
          {"linear_frequency_radps", "rad/s", "", "angular frequency of this gain"}}},
        {"strings/border.csv",
         "Written with `--sweep`. One row for each V2V delay.",
         {kPopulationColumn,
          kDelay,
          {"stable_time_gap_s", "s", "run",
           "smallest time gap without growth, interpolated between time gaps of the sweep; empty: none of them"},
          {"stable_time_gap_linear_s", "s", "", "the same by the linear analysis"}}},
    };
}

}  // namespace stopline
