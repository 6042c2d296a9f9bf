// Figures of sweeps over several intersections.
#include "experiment/network_sweep_figures.h"

#include <gtest/gtest.h>

#include "scenario/scenario_text.h"

namespace stopline {
namespace {

TEST(NetworkSweepFigures, AreDrawnWithoutTravelTimesUnderTitlesInWords) {
    if (!gnuplot_installed()) GTEST_SKIP() << "no gnuplot";
    const CsvTable results = parse_csv(
        "point,traffic,green_s,offset_s,population,seed,throughput_veh_h,travel_time_s,density_percent,stability\n"
        "0,{left: 5 %},10,0,A,1,0,,30,unstable\n",
        "table");
    ASSERT_TRUE(is_network_sweep(results));
    const std::vector<Figure> figures =
        network_sweep_figures(results, {{{"traffic", "{left: 5 %}"}, "traffic left 5 %"}});
    const TemporaryFolder folder;
    for (const Figure& figure : figures) {
        EXPECT_EQ(input_error_of([&] { draw(figure, folder.path()); }), "");
        EXPECT_TRUE(contains(figure.body, "'traffic left 5 %'"));
    }
}

}  // namespace
}  // namespace stopline
