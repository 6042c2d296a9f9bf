// Points of a sweep: every combination of values once, in the order of the file. Invalid sweeps are refused before any
// run.
#include "sweeps/sweep.h"

#include <gtest/gtest.h>

#include <set>

#include "sweeps/short_sweep.h"

namespace stopline {
namespace {

using Cells = std::vector<std::string>;

std::string error_of_sweep(const std::string& rest) { return ShortSweep("scenario: short.yaml\n" + rest).error(); }

TEST(Sweep, HasEveryCombinationOnceWithTheLastAxisFastest) {
    const Sweep sweep = ShortSweep().load();
    ASSERT_EQ(sweep.points(), 2U * 2U * 3U * 2U);
    EXPECT_EQ(sweep.combinations(), 4U);
    EXPECT_EQ(sweep.columns(), (Cells{"green_s", "vehicle", "population"}));
    EXPECT_EQ(sweep.cells(0), (Cells{"15", "petrol_eu4_72kw", "CDG"}));
    EXPECT_EQ(sweep.seed(0), 1U);
    EXPECT_EQ(sweep.cells(1), sweep.cells(0));
    EXPECT_EQ(sweep.seed(1), 2U);
    EXPECT_EQ(sweep.cells(2), (Cells{"15", "petrol_eu4_72kw", "MIX"}));
    EXPECT_EQ(sweep.cells(6), (Cells{"15", "electric_100kw", "CDG"}));
    EXPECT_EQ(sweep.cells(23), (Cells{"20", "electric_100kw", "CTG-Ref"}));
    std::set<std::pair<Cells, std::uint64_t>> all;
    for (std::size_t point = 0; point < sweep.points(); ++point) all.insert({sweep.cells(point), sweep.seed(point)});
    EXPECT_EQ(all.size(), sweep.points());
    EXPECT_EQ(sweep.describe(2), "green = 15 s, vehicle = petrol_eu4_72kw, population = MIX, seed = 1");
}

TEST(Sweep, PointsUseTheScenariosOfTheirCells) {
    const ShortSweep files;
    const Sweep sweep = files.load();
    for (std::size_t point = 0; point < sweep.points(); ++point) {
        const Scenario scenario = sweep.scenario(sweep.combination(point));
        EXPECT_EQ(scenario.signal.green_s, std::stod(sweep.cells(point)[0]));
        EXPECT_EQ(scenario.vehicle_name, sweep.cells(point)[1]);
        EXPECT_EQ(sweep.population(point), sweep.cells(point)[2]);
    }
}

TEST(Sweep, PopulationsCanBeAnAxisAtAnyPosition) {
    const ShortSweep files(R"(
scenario: short.yaml
axes:
- {name: mix, populations: [CTG-Ref, CDG]}
- {name: limit, path: network.approach.speed_limit, values: [30 km/h, 13.5 m/s]}
)");
    const Sweep sweep = files.load();
    ASSERT_EQ(sweep.points(), 4U);
    EXPECT_EQ(sweep.columns(), (Cells{"mix", "limit_kmh"}));
    EXPECT_EQ(sweep.cells(0), (Cells{"CTG-Ref", "30"}));
    EXPECT_EQ(sweep.cells(1), (Cells{"CTG-Ref", "48.6"}));
    EXPECT_EQ(sweep.cells(2), (Cells{"CDG", "30"}));
    EXPECT_EQ(sweep.combination(1), 1U);
    EXPECT_EQ(sweep.combination(2), 0U);
    EXPECT_EQ(sweep.population(2), "CDG");
    EXPECT_EQ(sweep.population_column(), "mix");
    EXPECT_EQ(ShortSweep().load().population_column(), "population");
}

TEST(Sweep, AnAxisCanSetSeveralFields) {
    const ShortSweep files(R"(
scenario: short.yaml
axes:
- name: penetration
  path: ['populations[MIX].components[0].share', 'populations[MIX].components[1].share']
  values: [29 % | 71 %, 100 % | 0 %]
- {name: speed, path: [network.approach.speed_limit, demand.entry_speed], values: [30 km/h]}
- {name: population, populations: MIX}
)");
    const Sweep sweep = files.load();
    ASSERT_EQ(sweep.points(), 2U);
    EXPECT_EQ(sweep.columns()[0], "penetration_percent");
    EXPECT_EQ(sweep.cells(0)[0], "29") << "not 28.999999999999996";
    const Scenario scenario = sweep.scenario(0);
    EXPECT_DOUBLE_EQ(scenario.populations[1].components[1].share, 0.71);
    EXPECT_EQ(scenario.demand.entry_speed_mps, scenario.network.approach.speed_limit_mps);
}

TEST(Sweep, ShowsAllFieldsOfAnAxisIfTheFirstIsAmbiguous) {
    const Sweep sweep = ShortSweep(R"(
scenario: short.yaml
axes:
- {name: light, path: [signal.yellow, signal.all_red], values: [3 s | 1 s, 3 s | 2 s]}
- {name: fast, path: [network.approach.speed_limit, demand.entry_speed], values: [30 km/h, 50 km/h | 40 km/h]}
)")
                            .load();
    EXPECT_EQ(sweep.columns(), (Cells{"light", "fast_kmh", "population"}));
    EXPECT_EQ(sweep.cells(0), (Cells{"3 s / 1 s", "30", "CDG"}));
    EXPECT_EQ(sweep.cells(sweep.points() - 1), (Cells{"3 s / 2 s", "50", "CTG-Ref"}));
    const CellTitles titles = sweep.titles();
    EXPECT_EQ(titles.at({"light", "3 s / 2 s"}), "light 3 s / 2 s");
    EXPECT_EQ(titles.at({"fast_kmh", "30"}), "fast 30 km/h");
    EXPECT_EQ(titles.at({"fast_kmh", "50"}), "fast 50 km/h / 40 km/h");
    EXPECT_EQ(titles.at({"population", "MIX"}), "population MIX");
}

TEST(Sweep, RefusesAnAxisWithTheNameOfAResultColumn) {
    const std::string error = error_of_sweep(
        "axes:\n- {name: queue_emptied, path: signal.green, values: [15 s, 20 s]}\n"
        "- {name: passed_3_veh, path: vehicle, values: [petrol_eu4_72kw]}\n");
    EXPECT_TRUE(contains(error,
                         "sweep.yaml:3:10: field 'axes[queue_emptied].name': the table of results has another column "
                         "'queue_emptied_s' (as 'queue_emptied'): rename the axis"));
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: passed_2_veh, path: vehicle, values: [petrol_eu4_72kw]}\n"),
                         "another column 'passed_2_veh': rename"));
    EXPECT_EQ(error_of_sweep("axes:\n- {name: passed_3_veh, path: vehicle, values: [petrol_eu4_72kw]}\n"), "")
        << "the scenario has two counts";
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: a, path: signal.green, values: [15 s]}\n"
                                        "- {name: a_s, path: vehicle, values: [petrol_eu4_72kw]}\n"),
                         "another column 'a_s'"));
}

TEST(Sweep, KeyCoversEverythingThatAffectsResults) {
    ShortSweep files;
    const std::string key = files.load().key();
    EXPECT_EQ(key, files.load({}, 2).key());
    EXPECT_EQ(key, ShortSweep().load().key()) << "the key must not depend on the folder";
    EXPECT_NE(key, files.load({"seed=2"}).key());
    EXPECT_NE(key, files.load({"signal.yellow=4 s"}).key());
    std::string text = kShortSweep;
    text.replace(text.find("repetitions: 2"), 14, "repetitions: 3");
    EXPECT_NE(key, ShortSweep(text).load().key());
    files.folder.write("short.yaml", std::string(kShortSweepScenario) + "step: 20 ms\n");
    EXPECT_NE(key, files.load().key());
}

TEST(Sweep, DetectsAChangeOfItsScenario) {
    const ShortSweep files;
    const Sweep sweep = files.load();
    files.folder.write("short.yaml", std::string(kShortSweepScenario) + "step: 20 ms\n");
    EXPECT_TRUE(contains(input_error_of([&] { static_cast<void>(sweep.scenario(0)); }), "has changed"));
}

TEST(Sweep, NamesTheInvalidCombination) {
    const std::string error = error_of_sweep(
        "axes:\n- {name: green, path: signal.green, values: [15 s, 5 s]}\n"
        "- {name: mass, path: vehicle.mass, values: [1 t, 2 t]}\n");
    EXPECT_TRUE(contains(error, "with green = 5 s, mass = 1 t:"));
    EXPECT_TRUE(contains(error, "measure.green[1]"));
}

TEST(Sweep, NamesThePlaceOfTheValueThatCausesAnError) {
    const std::string green = "- {name: green, path: signal.green, values: [15 s, 20 s]}\n";
    EXPECT_TRUE(contains(error_of_sweep("axes:\n" + green + "- {name: p, populations: [CDG, CTG]}\n"),
                         "sweep.yaml:4:32: the sweep sweep, with green = 15 s: "));
    EXPECT_TRUE(
        contains(error_of_sweep("axes:\n" + green + "- {name: car, path: vehicle, values: [electric_100kw, x]}\n"),
                 "sweep.yaml:4:55: "));
    // 7 ms is the cause: other times are no whole number of these steps, among them the values of the second axis.
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: step, path: step, values: [10 ms, 7 ms]}\n" + green),
                         "sweep.yaml:3:44: "));
    // Here no value fails without the other one.
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: step, path: step, values: [10 ms, 20 ms]}\n"
                                        "- {name: y, path: signal.yellow, values: [3 s, 3.01 s]}\n"),
                         "with step = 20 ms, y = 3.01 s: "));
}

TEST(Sweep, RefusesInvalidAxes) {
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: p, populations: [CDG, CTG]}\n"), "no population 'CTG'"));
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: p, populations: [CDG, all]}\n"),
                         "sweep.yaml:3:32: the sweep sweep: the scenario short has no population 'all'; to run all "
                         "populations, write 'populations: all' without other names"));
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: p, populations: [CDG, CTG-HBS]}\n"),
                         "has no population 'CTG-HBS', but a policy of this name: add it to the field 'populations' of "
                         "the scenario (known: CDG, "));
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: g, path: signal.green, values: [60 s, 1 min]}\n"),
                         "sweep.yaml:3:48: field 'axes[g].values[1]': '1 min' is the same value as '60 s'"));
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: g, path: [signal.yellow, signal.all_red], values: [3 s | 1 s, "
                                        "3000 ms | 1000 ms]}\n"),
                         "'3000 ms | 1000 ms' is the same value as '3 s | 1 s'"));
    EXPECT_TRUE(contains(ShortSweep().error({"signal.green=5 s"}), "'signal.green' is an axis"));
    EXPECT_TRUE(contains(ShortSweep().error({"signal={green: 5 s}"}), "'signal.green' is an axis"));
    EXPECT_TRUE(contains(error_of_sweep("axes:\n- {name: mass, path: vehicle.mass, values: [1 t, 2 t]}\n"
                                        "- {name: car, path: vehicle, values: [petrol_eu4_72kw]}\n"),
                         "the axes 'mass' and 'car' both change 'vehicle.mass'"));
    EXPECT_TRUE(contains(ShortSweep("scenario: none.yaml\n").error(), "none.yaml: no such file"));
}

TEST(Sweep, RefusesTooManyRunsBeforeLoadingThem) {
    struct HundredValues {
        const char* path;
        const char* unit;
        int from;
    };
    std::string axes = "axes:\n";
    for (const HundredValues& axis :
         {HundredValues{"driver.cacc.v2v_delay", "ms", 100}, HundredValues{"driver.cacc.radar_delay", "ms", 100},
          HundredValues{"network.approach.length", "m", 500}, HundredValues{"vehicle.mass", "kg", 1000},
          HundredValues{"network.approach.exit_length", "m", 500}, HundredValues{"demand.vehicles", "", 1}}) {
        axes += std::string("- {name: ") + axis.path + ", path: " + axis.path + ", values: [";
        for (int i = 0; i < 100; ++i) {
            axes += (i == 0 ? "" : ", ") + std::to_string(axis.from + i) + " " + axis.unit;
        }
        axes += "]}\n";
    }
    EXPECT_TRUE(contains(error_of_sweep(axes), "more than 10000000 runs (3000000000000)"));
    EXPECT_TRUE(contains(error_of_sweep(axes + "repetitions: 1000000\n"), "more than 10000000 runs"));
}

TEST(Shard, DividesThePointsEvenly) {
    for (const std::size_t count : {1U, 2U, 3U, 7U, 24U, 30U}) {
        std::vector<int> owners(24, 0);
        std::vector<int> sizes;
        for (std::size_t index = 1; index <= count; ++index) {
            int size = 0;
            for (std::size_t point = 0; point < owners.size(); ++point) {
                if (!Shard{index, count}.has(point)) continue;
                ++owners[point];
                ++size;
            }
            sizes.push_back(size);
        }
        EXPECT_EQ(owners, std::vector<int>(24, 1)) << count;
        const auto [least, most] = std::minmax_element(sizes.begin(), sizes.end());
        EXPECT_LE(*most - *least, 1) << count;
    }
}

TEST(Shard, CoversAllValuesOfAnAxisWithAsManyValuesAsShards) {
    std::set<std::size_t> values;
    for (std::size_t point = 0; point < 24; ++point) {
        if (Shard{2, 3}.has(point)) values.insert(point % 3);
    }
    EXPECT_EQ(values.size(), 3U);
}

TEST(Shard, RefusesInvalidTexts) {
    EXPECT_EQ(parse_shard("2/8").index, 2U);
    EXPECT_EQ(parse_shard("8/8").count, 8U);
    for (const char* text :
         {"5/4", "0/4", "1", "1/", "/4", "1/0", "-1/4", "1/4/2", "a/b", "", "1/99999999999999999999"}) {
        EXPECT_TRUE(contains(input_error_of([&] { parse_shard(text); }), "must be K/N")) << text;
    }
}

}  // namespace
}  // namespace stopline
