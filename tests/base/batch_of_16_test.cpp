#define STOPLINE_BATCH_WIDTH 16
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf16, MatchesSingleInArithmetic) { check_batch_arithmetic(); }
TEST(BatchOf16, MatchesSingleInLoadsAndStores) { check_batch_loads_and_stores(); }
TEST(BatchOf16, MatchesSingleInTableLookups) {
    check_batch_tables<8>();
    check_batch_tables<16>();
    check_batch_tables<32>();
}
TEST(BatchOf16, DetectsEachSetFlag) { check_any(); }

}  // namespace
}  // namespace stopline
