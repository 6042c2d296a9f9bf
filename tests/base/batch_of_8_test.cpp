#define STOPLINE_BATCH_WIDTH 8
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf8, MatchesSingleInArithmetic) { check_batch_arithmetic(); }
TEST(BatchOf8, MatchesSingleInLoadsAndStores) { check_batch_loads_and_stores(); }
TEST(BatchOf8, MatchesSingleInTableLookups) {
    check_batch_tables<8>();
    check_batch_tables<16>();
    check_batch_tables<32>();
}
TEST(BatchOf8, DetectsEachSetFlag) { check_any(); }

}  // namespace
}  // namespace stopline
