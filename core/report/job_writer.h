// What the jobs share: writing tables and figures into a job's folder, and saying under which conditions they were made.
#pragma once

#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/scorecard_sweeps.h"
#include "report/job.h"
#include "scenario/scenario.h"

namespace stopline {

class JobWriter {
public:
    explicit JobWriter(const JobContext& context) : context_(context) {}

    JobOutput output;

    void table(const std::string& name, const std::string& csv);
    // Draws; a reduced job's figures say so. `subfolder`: where a job has two figures of one name. Throws InputError as draw() does, and
    // Interrupted.
    void figure(Figure figure, const std::string& subfolder = "");
    void figures(std::vector<Figure> figures, const std::string& subfolder = "");
    // Of an experiment of the scorecard: measures it and keeps what it measured.
    void experiment(const std::string& name);

    void condition(const std::string& what, const std::string& words);
    // Scenario, fidelity, vehicle, driver, duration and populations, and its seed.
    void conditions_of(const Scenario& scenario);
    // The same of a sweep's scenario, its axes and seeds.
    void conditions_of(const Sweep& sweep);
    // A command in full: program, file in scenarios/ and words after it. A reduced job's figures come from stopline-reproduce alone.
    void command(const std::string& text);

private:
    const JobContext& context_;
};

// "REDUCED" on a figure, along its right edge.
Figure marked_as_reduced(Figure figure);

// A scenario of the project, reduced as the job is.
Scenario scenario_named(const JobContext& context, const std::string& name,
                        const std::vector<std::string>& settings = {});

// "1", "1 to 6", "1, 5"
std::string seeds_text(const std::set<std::uint64_t>& seeds);

}  // namespace stopline
