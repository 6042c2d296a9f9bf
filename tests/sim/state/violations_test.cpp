// The first violation does not depend on the order in which the partitions (the lanes of one thread) report violations.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sim/state/events.h"

namespace stopline {
namespace {

TEST(Violations, FirstIsTheEarliestInAnyOrder) {
    std::vector<Violation> observed{{2.0, Violation::Kind::conflict, 7, 3, 4},
                                    {2.0, Violation::Kind::overlap, 5, 9, 1},
                                    {2.0, Violation::Kind::overlap, 5, 2, 9},
                                    {2.1, Violation::Kind::overlap, 1, 1, 2}};
    std::vector<int> order{0, 1, 2, 3};
    do {
        Violations all;
        for (const int k : order) {
            Violations part;
            part.record(observed[static_cast<std::size_t>(k)]);
            all.add(part);
            all.add({});
        }
        EXPECT_EQ(all.first.time_s, 2.0);
        EXPECT_EQ(all.first.lane, 5);
        EXPECT_EQ(all.first.vehicle, 2);
    } while (std::next_permutation(order.begin(), order.end()));
}

}  // namespace
}  // namespace stopline
