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
    // Draws a figure into the subfolder, where no other figure may have the same name. If the job is reduced (it runs
    // less than the paper does, reductions.h), adds the mark "REDUCED" to the figure. Throws InputError if drawing
    // fails. Throws Interrupted if on_progress returns false.
    void figure(Figure figure, const std::string& subfolder = "");
    void figures(std::vector<Figure> figures, const std::string& subfolder = "");
    // Runs an experiment of the scorecard and stores its measurements in the folder of the job.
    void experiment(const std::string& name);

    void condition(const std::string& name, const std::string& text);
    // Records scenario, fidelity, vehicle, driver, duration, populations and seed.
    void conditions_of(const Scenario& scenario);
    // Records the conditions of the first run of a sweep. Also records the axis values, the number of runs and the
    // seeds.
    void conditions_of(const Sweep& sweep);
    // Records a command line that repeats the runs. A reduced job records no command, because only stopline-reproduce
    // can repeat reduced runs.
    void command(const std::string& text);

private:
    const JobContext& context_;
};

// Returns the figure with the mark "REDUCED" along its right edge.
Figure marked_as_reduced(Figure figure);

// Loads scenarios/NAME.yaml with the overrides `settings` and the reductions of the job.
Scenario scenario_named(const JobContext& context, const std::string& name,
                        const std::vector<std::string>& settings = {});

// Returns the seeds as text, such as "1", "1 to 6" or "1, 5".
std::string seeds_text(const std::set<std::uint64_t>& seeds);

}  // namespace stopline
