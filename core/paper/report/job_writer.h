// Writes tables and figures into the folder of a job, and records the conditions of its runs.
#pragma once

#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "paper/report/job.h"
#include "paper/sections/scorecard_sweeps.h"
#include "scenario/scenario.h"

namespace stopline {

class JobWriter {
public:
    explicit JobWriter(const JobContext& context) : context_(context) {}

    JobOutput output;

    void table(const std::string& name, const std::string& csv);
    // Draws a figure and marks it if the job is reduced. `subfolder` separates figures of the same name. Throws
    // InputError as draw() does, and Interrupted.
    void figure(Figure figure, const std::string& subfolder = "");
    void figures(std::vector<Figure> figures, const std::string& subfolder = "");
    // Runs an experiment of the scorecard and stores its measurements.
    void experiment(const std::string& name);

    void condition(const std::string& name, const std::string& text);
    // Records scenario, fidelity, vehicle, driver, duration, populations and seed.
    void conditions_of(const Scenario& scenario);
    // Records the same for a sweep, with its axes and seeds.
    void conditions_of(const Sweep& sweep);
    // Records a full command that repeats the runs. A reduced job records none, because only stopline-reproduce reduces
    // runs.
    void command(const std::string& text);

private:
    const JobContext& context_;
};

// Adds the mark "REDUCED" along the right edge of a figure.
Figure marked_as_reduced(Figure figure);

// Loads a scenario of the project with the reductions of the job.
Scenario scenario_named(const JobContext& context, const std::string& name,
                        const std::vector<std::string>& settings = {});

// Returns the seeds as text, such as "1", "1 to 6" or "1, 5".
std::string seeds_text(const std::set<std::uint64_t>& seeds);

}  // namespace stopline
