// Functions that run the jobs, by section of the paper. Each comment names the figures and tables of the paper that the
// job reproduces. job_list.cpp lists all jobs.
#pragma once

#include "paper/report/job.h"
#include "paper/sections/scorecard_sweeps.h"

namespace stopline {

// Sections III and IV.
JobOutput run_startup_job(const JobContext& context);             // Fig. 2
JobOutput run_single_light_job(const JobContext& context);        // Fig. 5, 6
JobOutput run_intersection_job(const JobContext& context);        // Fig. 8
JobOutput run_intersection_table_job(const JobContext& context);  // no figure; rows of the scorecard
JobOutput run_intersection_sweep_job(const JobContext& context);  // Fig. 9, Table 1

// Section V.
JobOutput run_calibration_times_job(const JobContext& context);  // Fig. 11, Table 2
JobOutput run_calibration_bands_job(const JobContext& context);  // Fig. 12

// Section VI.
JobOutput run_situations_job(const JobContext& context);  // Fig. 16
JobOutput run_platoons_job(const JobContext& context);    // no figure; rows of the scorecard
JobOutput run_arterial_job(const JobContext& context);    // Fig. 17, 18
JobOutput run_grid_job(const JobContext& context);        // Fig. 19, 20
JobOutput run_stability_job(const JobContext& context);   // Fig. 21
JobOutput run_unstable_job(const JobContext& context);    // Fig. 22

// Section VII.
JobOutput run_berlin_sweep_job(const JobContext& context);  // no figure; rows of the scorecard
JobOutput run_berlin_job(const JobContext& context);        // Fig. 24 to 26

// Beyond the paper: coordination between vehicles. No figures; rows of the scorecard.
JobOutput run_clearing_grid_job(const JobContext& context);
JobOutput run_coordination_berlin_job(const JobContext& context);
JobOutput run_energy_intersection_job(const JobContext& context);
JobOutput run_energy_grid_job(const JobContext& context);

// Runs the intersection sweep in full dynamics, or loads its stored runs. Sections IV and V share these runs.
SweepRuns intersection_runs(const ScorecardOptions& options, ProgressRange range);

}  // namespace stopline
