// Tests that fields without effect on a kind of network are refused. Without the error, a user would take the unchanged
// results for the effect of the field.
#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

struct UnusedField {
    const char* kind;
    const char* setting;
    const char* remark;
};

void PrintTo(const UnusedField& unused, std::ostream* out) { *out << unused.kind << ": " << unused.setting; }

class UnusedFields : public ::testing::TestWithParam<UnusedField> {};

std::string network_of(const std::string& kind) {
    if (kind == "streets") return "network: {kind: streets, streets: three_lanes}\nduration: 100 s\n";
    return "network: {kind: " + kind + "}\n";
}

TEST_P(UnusedFields, AreRefused) {
    const std::string setting = GetParam().setting;
    const std::string error = error_of(network_of(GetParam().kind), {setting});
    EXPECT_TRUE(contains(error, "--set '" + setting + "': field '" + setting.substr(0, setting.find_first_of("=["))));
    EXPECT_TRUE(contains(error, GetParam().remark));
}

constexpr const char* kLight = "is for a single light only (network.kind: approach)";
constexpr const char* kIntersection = "is for a single intersection only (network.kind: intersection)";
constexpr const char* kNetwork = "is for networks of several intersections only";
constexpr const char* kArea = "is for grids and streets only";

INSTANTIATE_TEST_SUITE_P(
    OfKinds, UnusedFields,
    ::testing::Values(UnusedField{"intersection", "measure.green=[5 s]", kLight},
                      UnusedField{"grid", "measure.green=[5 s]", kLight},
                      UnusedField{"streets", "measure.green=[5 s]", kLight},
                      UnusedField{"approach", "measure.zones=[30 m]", kIntersection},
                      UnusedField{"grid", "measure.zones=[30 m]", kIntersection},
                      UnusedField{"streets", "measure.zones=[30 m]", kIntersection},
                      UnusedField{"approach", "measure.cycles=2", kIntersection},
                      UnusedField{"grid", "measure.cycles=2", kIntersection},
                      UnusedField{"streets", "measure.warmup_cycles=2", kIntersection},
                      UnusedField{"approach", "measure.warmup_cycles=2", kIntersection},
                      UnusedField{"approach", "measure.window=60 s", kNetwork},
                      UnusedField{"intersection", "measure.window=60 s", kNetwork},
                      UnusedField{"approach", "measure.interval=5 s", kNetwork},
                      UnusedField{"intersection", "measure.interval=5 s", kNetwork},
                      UnusedField{"approach", "measure.area_margin=5 m", kArea},
                      UnusedField{"intersection", "measure.area_margin=5 m", kArea},
                      UnusedField{"approach", "measure.starvation=60 s", "is for networks with intersections only"},
                      UnusedField{"approach", "signal.offset=5 s", "is for grids only"},
                      UnusedField{"intersection", "signal.offset=5 s", "is for grids only"},
                      UnusedField{"approach", "signal.cross_green=5 s", "is for intersections and grids only"},
                      UnusedField{"approach", "signal.clock=7 h", "acts only with signal.programmes"}));

TEST(UnusedFields, AGradientIsRefusedInTheMesoscaleMode) {
    const std::string error = error_of(network_of("approach"), {"fidelity=meso", "network.approach.gradient=3 %"});
    EXPECT_TRUE(contains(error, "--set 'network.approach.gradient=3 %': field 'network.approach.gradient'"));
    EXPECT_TRUE(contains(error, "no effect in the mesoscale mode"));
    EXPECT_EQ(error_of(network_of("approach"), {"network.approach.gradient=3 %"}), "");
}

// Files for both fidelities give the parameters of both.
TEST(UsedFields, AreAccepted) {
    EXPECT_EQ(error_of(network_of("approach"), {"measure.green=[5 s]", "meso=passages"}), "");
    EXPECT_EQ(error_of(network_of("approach"), {"step=20 ms", "fidelity=meso"}), "");
    EXPECT_EQ(
        error_of(network_of("intersection"), {"measure.zones=[30 m]", "measure.cycles=2", "measure.warmup_cycles=2",
                                              "signal.cross_green=5 s", "measure.starvation=60 s"}),
        "");
    EXPECT_EQ(error_of(network_of("grid"), {"measure.window=60 s", "measure.interval=5 s", "measure.area_margin=5 m",
                                            "signal.offset=5 s", "signal.cross_green=5 s"}),
              "");
}

// The canonical text has all fields, also those without effect.
TEST(UsedFields, CanHaveTheirDefaults) {
    for (const char* kind : {"approach", "intersection", "grid", "streets"}) {
        const std::string text = canonical_text(parse_scenario(network_of(kind), "test.yaml"));
        EXPECT_EQ(error_of(text), "") << kind;
    }
}

}  // namespace
}  // namespace stopline
