#define STOPLINE_BATCH_WIDTH 8
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf8, ComputesTheBitsOfSingle) { check_batch_arithmetic(); }
TEST(BatchOf8, LoadsAndStoresAsSingleDoes) { check_batch_loads_and_stores(); }
TEST(BatchOf8, LooksUpAsSingleDoes) {
    check_batch_tables<8>();
    check_batch_tables<16>();
    check_batch_tables<32>();
}
TEST(BatchOf8, SeesWhetherAFlagIsSet) { check_any(); }

}  // namespace
}  // namespace stopline
