#define STOPLINE_BATCH_WIDTH 2
#include "base/batch_checks.h"

namespace stopline {
namespace {

TEST(BatchOf2, ComputesTheBitsOfDouble) { check_batch_arithmetic(); }
TEST(BatchOf2, LoadsAndStoresAsDoubleDoes) { check_batch_loads_and_stores(); }

}  // namespace
}  // namespace stopline
