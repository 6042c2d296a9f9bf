#define STOPLINE_BATCH_WIDTH 2
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf2, ComputesTheBitsOfDouble) { check_batch_arithmetic(); }
TEST(BatchOf2, LoadsAndStoresAsDoubleDoes) { check_batch_loads_and_stores(); }
TEST(BatchOf2, LooksUpAsDoubleDoes) {
    check_batch_tables<8>();
    check_batch_tables<16>();
    check_batch_tables<32>();
}

}  // namespace
}  // namespace stopline
