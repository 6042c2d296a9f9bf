#define STOPLINE_BATCH_WIDTH 4
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf4, ComputesTheBitsOfSingle) { check_batch_arithmetic(); }
TEST(BatchOf4, LoadsAndStoresAsSingleDoes) { check_batch_loads_and_stores(); }
TEST(BatchOf4, LooksUpAsSingleDoes) {
    check_batch_tables<8>();
    check_batch_tables<16>();
    check_batch_tables<32>();
}
TEST(BatchOf4, SeesWhetherAFlagIsSet) { check_any(); }

}  // namespace
}  // namespace stopline
