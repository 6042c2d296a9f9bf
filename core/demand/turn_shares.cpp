#include "demand/turn_shares.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace stopline {

namespace {

double sum_of(const TurnShares& row) { return std::accumulate(row.begin(), row.end(), 0.0); }

// Scales all rows to their target sums, then all columns. Returns the largest deviation of a sum from its target. The
// sum of a row or column is computed just before this row or column is scaled.
double fit_once(std::vector<TurnShares>& matrix, const TurnShares& shares) {
    const double row = 1.0 / static_cast<double>(matrix.size());
    double change = 0.0;
    for (TurnShares& lane : matrix) {
        const double sum = sum_of(lane);
        if (sum <= 0.0) continue;
        change = std::max(change, std::abs(sum - row));
        for (double& entry : lane) entry *= row / sum;
    }
    for (std::size_t turn = 0; turn < shares.size(); ++turn) {
        double sum = 0.0;
        for (const TurnShares& lane : matrix) sum += lane[turn];
        if (sum <= 0.0) continue;
        change = std::max(change, std::abs(sum - shares[turn]));
        for (TurnShares& lane : matrix) lane[turn] *= shares[turn] / sum;
    }
    return change;
}

}  // namespace

std::vector<TurnShares> turns_by_lane(const std::vector<TurnsAllowed>& allowed, const TurnShares& shares) {
    constexpr int kMaxRounds = 10'000;
    constexpr double kTolerance = 1e-13;
    std::vector<TurnShares> matrix(allowed.size());
    for (std::size_t lane = 0; lane < allowed.size(); ++lane) {
        for (std::size_t turn = 0; turn < shares.size(); ++turn) {
            matrix[lane][turn] = allowed[lane][turn] && shares[turn] > 0.0 ? 1.0 : 0.0;
        }
    }
    for (int round = 0; round < kMaxRounds && fit_once(matrix, shares) > kTolerance; ++round) continue;
    for (TurnShares& lane : matrix) {
        const double sum = sum_of(lane);
        if (sum <= 0.0) lane = shares;
        for (double& entry : lane) entry /= sum > 0.0 ? sum : 1.0;
    }
    return matrix;
}

}  // namespace stopline
