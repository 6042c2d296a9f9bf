#define STOPLINE_BATCH_WIDTH 8
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf8, ComputesTheBitsOfDouble) { check_batch_arithmetic(); }
TEST(BatchOf8, LoadsAndStoresAsDoubleDoes) { check_batch_loads_and_stores(); }

}  // namespace
}  // namespace stopline
