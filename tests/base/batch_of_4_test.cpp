#define STOPLINE_BATCH_WIDTH 4
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf4, MatchesSingleInArithmetic) { check_batch_arithmetic(); }
TEST(BatchOf4, MatchesSingleInLoadsAndStores) { check_batch_loads_and_stores(); }
TEST(BatchOf4, MatchesSingleInTableLookups) {
    check_batch_tables<8>();
    check_batch_tables<16>();
    check_batch_tables<32>();
}
TEST(BatchOf4, DetectsEachSetFlag) { check_any(); }

}  // namespace
}  // namespace stopline
