// Checks the slots that lanes own in memory in the mesoscale mode: no two lanes ever share a slot.
#include <gtest/gtest.h>

#include <vector>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

// Each lane owns a block of slots, the places for its vehicles in memory. Checks that the blocks are in order and
// disjoint, and that a slot has a vehicle id exactly if it holds a vehicle.
void check_blocks(const State& state) {
    int first_free = 1;
    for (const Partition& part : state.partitions) {
        for (const int lane : part.lanes) {
            const LaneBlock& block = state.blocks[static_cast<std::size_t>(lane)];
            ASSERT_GT(block.begin, first_free) << "no slot for the sentinel of lane " << lane;
            ASSERT_GE(block.first, block.begin);
            ASSERT_LE(block.past_last(), block.end);
            for (int slot = first_free; slot < block.end; ++slot) {
                const bool occupied = slot >= block.first && slot < block.past_last();
                ASSERT_EQ(state.vehicles.id[static_cast<std::size_t>(slot)] >= 0, occupied) << slot;
            }
            first_free = block.end;
        }
    }
    ASSERT_LT(first_free, state.vehicles.slots);
}

TEST(LaneBlocks, AreDisjointWithEmptySlotsBetween) {
    for (const std::size_t population : {0u, 2u}) {
        const Model model =
            network_model(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", {"signal.green=20 s"}), population);
        Simulation simulation(model, 2);
        for (int second = 1; second <= 400; second += 3) {
            simulation.run_until(second);
            check_blocks(simulation.state());
            if (HasFatalFailure()) return;
        }
    }
}

}  // namespace
}  // namespace stopline
