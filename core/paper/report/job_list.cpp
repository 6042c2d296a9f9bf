#include "paper/report/job.h"
#include "paper/report/jobs.h"

namespace stopline {

namespace {

bool in_iii(const std::string& section) { return section == "III"; }
bool in_iv(const std::string& section) { return section == "IV"; }
bool in_v(const std::string& section) { return section == "V"; }
bool in_vi(const std::string& section) { return section == "VI"; }
bool in_vii(const std::string& section) { return section == "VII"; }
bool in_coordination(const std::string& section) { return section == "coordination"; }
bool in_energy(const std::string& section) { return section == "energy"; }
// Fig. 23 compares grid and arterial with the single intersection, so Section VI also needs the intersection job.
bool in_iv_or_vi(const std::string& section) { return in_iv(section) || in_vi(section); }

}  // namespace

const std::vector<Job>& all_jobs() {
    // The two numbers are the expected durations of the full job and of the reduced job, s. They were measured with one
    // thread on a virtual machine with two processors (AMD EPYC). To update them, see times.csv of a reproduction.
    static const std::vector<Job> kJobs{
        {"startup", "III", "start of a platoon leader", 1, 1, in_iii, run_startup_job},
        {"single_light", "III", "single signal", 2, 2, in_iii, run_single_light_job},
        {"intersection", "IV", "one intersection in detail", 2, 2, in_iv, run_intersection_job},
        {"intersection_table", "IV", "intersection, rows of the scorecard", 100, 17, in_iv_or_vi,
         run_intersection_table_job},
        {"intersection_sweep", "IV", "intersection, all permutations", 500, 30, in_iv, run_intersection_sweep_job},
        {"calibration_times", "V", "calibration, passages at detectors", 7, 4, in_v, run_calibration_times_job},
        {"calibration_bands", "V", "calibration, confidence bands", 45, 4, in_v, run_calibration_bands_job},
        {"arterial_situations", "VI", "four situations on the arterial", 8, 1, in_vi, run_situations_job},
        {"arterial_platoons", "VI", "platoons on the arterial", 10, 2, in_vi, run_platoons_job},
        {"arterial", "VI", "arterial, all permutations", 106, 10, in_vi, run_arterial_job},
        {"grid", "VI", "grid, all permutations", 1250, 113, in_vi, run_grid_job},
        {"grid_stability", "VI", "stability of the grid", 600, 54, in_vi, run_stability_job},
        {"grid_unstable", "VI", "an unstable run of the grid", 38, 4, in_vi, run_unstable_job},
        {"berlin_sweep", "VII", "Berlin, all permutations", 308, 52, in_vii, run_berlin_sweep_job},
        {"berlin", "VII", "Berlin in detail", 26, 26, in_vii, run_berlin_job},
        {"clearing_grid", "coordination", "grid with cooperative clearing", 120, 8, in_coordination,
         run_clearing_grid_job},
        {"coordination_four_lanes", "coordination", "Berlin with coordination", 150, 20, in_coordination,
         run_coordination_berlin_job},
        {"energy_intersection", "energy", "energy at the intersection", 60, 8, in_energy, run_energy_intersection_job},
        {"energy_grid", "energy", "energy on the grid", 20, 5, in_energy, run_energy_grid_job}};
    return kJobs;
}

std::vector<const Job*> jobs_of(const std::string& section) {
    std::vector<const Job*> jobs;
    for (const Job& job : all_jobs()) {
        if (section == "all" || job.is_needed_by(section)) jobs.push_back(&job);
    }
    return jobs;
}

ScorecardOptions JobContext::scorecard() const {
    ScorecardOptions options;
    options.folder = stores;
    options.reductions = reductions;
    options.threads = threads;
    options.on_progress = on_progress;
    options.on_stored = on_stored;
    return options;
}

}  // namespace stopline
