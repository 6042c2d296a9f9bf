#include "record/recording/recording_header.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/version.h"
#include "record/recording/recording_format.h"
#include "record/recording/vehicle_links.h"
#include "sim/state/delay_log.h"

namespace stopline {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kTurnNames{"none", "straight", "right", "left"};

// Returns the name of a turn. Imported networks have further turns, which are numbered.
std::string turn_name(Turn turn) {
    const auto number = static_cast<std::size_t>(turn);
    return number < kTurnNames.size() ? kTurnNames[number] : "turn " + std::to_string(number);
}

// Returns a length in metres, rounded to millimetres.
double round_to_mm(double length_m) { return std::round(length_m * 1000.0) / 1000.0; }

// Returns a lane as JSON. Signal group 0 of an imported network is always green, so the JSON omits it.
Json lane_json(const Lane& lane, bool imported) {
    Json json{{"name", lane.name}, {"length_m", lane.length_m}, {"limit_mps", lane.limit_mps}, {"next", lane.next}};
    if (lane.signal_group >= (imported ? 1 : 0)) json["signal_group"] = lane.signal_group;
    if (lane.signal_group >= 0) json["stop_line_m"] = lane.stop_line_m;
    if (lane.origin >= 0) {
        json["origin"] = lane.origin;
        json["turn"] = turn_name(lane.turn);
    }
    json["shape_start_m"] = lane.shape_start_m;
    if (lane.shape_scale != 1.0) json["shape_scale"] = lane.shape_scale;
    json["shape"] = Json::array();
    for (const Point& point : lane.shape) {
        json["shape"].push_back(round_to_mm(point.x_m));
        json["shape"].push_back(round_to_mm(point.y_m));
    }
    return json;
}

[[noreturn]] void fail_range(const char* name) {
    throw InputError(std::string("the header has a value out of range: ") + name);
}

// Returns a whole number of the header. Throws InputError if it is not from `min` to `max`.
std::int64_t whole_number(const nlohmann::json& object, const char* name, std::int64_t min, std::int64_t max) {
    const nlohmann::json& number = object.at(name);
    if (!number.is_number_integer()) fail_range(name);
    const auto value = number.get<std::int64_t>();
    if (value < min || value > max) fail_range(name);
    return value;
}

// Returns a number of the header. Throws InputError if it is not from `min` to `max`.
double number(const nlohmann::json& object, const char* name, double min, double max) {
    const double value = object.at(name).get<double>();
    if (!(value >= min && value <= max)) fail_range(name);
    return value;
}

FrameGrid grid_of(const nlohmann::json& json) {
    constexpr double kMinStep_s = 1e-4;
    constexpr double kMaxStep_s = 100.0;
    constexpr double kMaxTime_s = 1e9;
    constexpr double kMaxUnit_m = 1e3;
    FrameGrid grid;
    grid.step_s = number(json, "step_s", kMinStep_s, kMaxStep_s);
    grid.frame_ticks = std::llround(number(json, "frame_s", 0.0, kMaxTime_s) / grid.step_s);
    if (grid.frame_ticks == 0) fail_range("frame_s");
    grid.first_tick = std::llround(number(json, "first_frame_s", 0.0, kMaxTime_s) / grid.step_s);
    grid.position_unit_m = number(json, "position_unit_m", 1e-6, kMaxUnit_m);
    grid.advance_q12 = static_cast<std::uint32_t>(whole_number(json, "advance_q12", 0, kMaxAdvance));
    return grid;
}

RecordedRun run_of(const nlohmann::json& json) {
    constexpr std::int64_t kMaxSignalGroups = 10'000'000;
    constexpr double kMaxLength_m = 1e7;
    if (!json.at("seed").is_number_unsigned()) fail_range("seed");
    RecordedRun run;
    run.version = json.at("version");
    run.origin = {json.at("command"), json.at("scenario"),   json.at("title"),       json.at("scenario_hash"),
                  json.at("seed"),    json.at("population"), json.at("lane_width_m")};
    run.grid = grid_of(json);
    run.policies = json.at("policies");
    run.causes = json.at("causes");
    run.links = json.value("links", std::vector<std::string>{});
    run.signal_groups = static_cast<int>(whole_number(json, "signal_groups", 0, kMaxSignalGroups));
    for (const nlohmann::json& lane : json.at("lanes")) {
        const bool has_line = lane.contains("stop_line_m");
        const bool has_group = lane.contains("signal_group");
        run.lanes.push_back(
            {lane.at("name"), number(lane, "length_m", 0.0, kMaxLength_m),
             has_group ? static_cast<int>(whole_number(lane, "signal_group", 0, run.signal_groups - 1)) : -1,
             has_line ? number(lane, "stop_line_m", -kMaxLength_m, kMaxLength_m) : 0.0});
    }
    if (run.lanes.empty()) fail_range("lanes");
    if (run.policies.empty()) fail_range("policies");
    return run;
}

// Parses the header. Refuses deep nesting, which needs much more memory than the text.
nlohmann::json parse(std::string_view text) {
    constexpr int kMaxDepth = 10;
    return nlohmann::json::parse(text,
                                 [](int depth, nlohmann::json::parse_event_t /*event*/, nlohmann::json& /*part*/) {
                                     if (depth > kMaxDepth) throw InputError("the header is nested too deeply");
                                     return true;
                                 });
}

}  // namespace

FrameGrid make_frame_grid(const Model& model, const FrameClock& clock) {
    constexpr double kMaxCode = 65535.0;
    double longest_m = 0.0;
    for (const Lane& lane : model.graph.lanes) longest_m = std::max(longest_m, lane.length_m);
    FrameGrid grid;
    grid.step_s = model.step_s;
    grid.frame_ticks = clock.frame_ticks();
    grid.first_tick = clock.first_tick();
    grid.position_unit_m = kFinestPosition_m * std::max(std::ceil(longest_m / (kMaxCode * kFinestPosition_m)), 1.0);
    const double frame_s = static_cast<double>(grid.frame_ticks) * model.step_s;
    const double advance_q12 = std::round(0.5 * frame_s * kSpeedUnit_mps / grid.position_unit_m * 4096.0);
    grid.advance_q12 = static_cast<std::uint32_t>(std::min(advance_q12, static_cast<double>(kMaxAdvance)));
    return grid;
}

std::string recording_header(const Model& model, const RunOrigin& origin, const FrameGrid& grid) {
    Json json{{"program", "stopline"},
              {"version", version()},
              {"command", origin.command},
              {"scenario", origin.scenario},
              {"title", origin.title},
              {"scenario_hash", origin.scenario_hash},
              {"seed", origin.seed},
              {"population", origin.population},
              {"fidelity", model.meso ? "meso" : "full"},
              {"step_s", model.step_s},
              {"frame_s", static_cast<double>(grid.frame_ticks) * model.step_s},
              {"first_frame_s", grid.time_s(0)},
              {"position_unit_m", grid.position_unit_m},
              {"speed_unit_mps", kSpeedUnit_mps},
              {"advance_q12", grid.advance_q12},
              {"policies", Json::array()},
              {"causes", kDelayCauseNames},
              {"signal_groups", model.graph.signal_groups},
              {"lane_width_m", origin.lane_width_m},
              {"lanes", Json::array()},
              {"entries", model.graph.entries}};
    for (const LinkKind* kind : link_kinds_of(model)) json["links"].push_back(kind->name);
    for (const GapPolicy& policy : model.policies) json["policies"].push_back(policy.settings.name);
    for (const Lane& lane : model.graph.lanes) json["lanes"].push_back(lane_json(lane, model.is_imported()));
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

RecordedRun parse_recording_header(std::string_view json) {
    try {
        return run_of(parse(json));
    } catch (const nlohmann::json::exception& error) {
        throw InputError(std::string("the header is not valid: ") + error.what());
    }
}

}  // namespace stopline
