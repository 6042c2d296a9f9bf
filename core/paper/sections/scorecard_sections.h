// Experiments and row functions of each section of the paper, and of the own rows. scorecard.h explains these terms.
#pragma once

#include <span>

#include "paper/scorecard.h"

namespace stopline {

std::span<const Experiment> section3_experiments();
std::span<const RowJudge> section3_rows();

std::span<const Experiment> section4_experiments();
std::span<const RowJudge> section4_rows();

std::span<const Experiment> section5_experiments();
std::span<const RowJudge> section5_rows();

std::span<const Experiment> section6_experiments();
std::span<const RowJudge> section6_rows();

std::span<const Experiment> section7_experiments();
std::span<const RowJudge> section7_rows();

std::span<const Experiment> coordination_experiments();
std::span<const RowJudge> coordination_rows();

std::span<const Experiment> energy_experiments();
std::span<const RowJudge> energy_rows();

}  // namespace stopline
