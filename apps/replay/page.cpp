#include "replay/page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/io/base64.h"
#include "base/io/escape.h"
#include "figures/population_style.h"
#include "record/recording/bytes.h"
#include "record/recording/frame_decoder.h"
#include "replay/packing.h"
#include "replay_page_files.h"
#include "runs/interrupted.h"

namespace stopline {

namespace {

constexpr std::size_t kMaxBytes = 400'000'000;  // below the limit of about 500 MB for strings in browsers

// Counts vehicles and passages of stop lines, from the first frame of the recording on.
class VehicleCounter {
public:
    explicit VehicleCounter(const RecordedRun& run) : run_(run) {}

    void add_frame(const FrameDecoder& frame) {
        present_ = 0;
        links_.assign(run_.links.size(), 0);
        for (const VehicleLink& link : frame.links()) ++links_[static_cast<std::size_t>(link.kind)];
        exited_ += static_cast<std::uint32_t>(frame.exited());
        std::unordered_map<int, Position> now;
        for (const RecordedVehicle& seat : frame.seats()) {
            if (seat.vehicle < 0) continue;
            ++present_;
            const Position position{seat.lane, seat.position};
            const auto before = last_positions_.find(seat.vehicle);
            if (before != last_positions_.end() && passes(before->second, position)) ++passages_;
            now.emplace(seat.vehicle, position);
        }
        last_positions_ = std::move(now);
    }

    std::uint32_t present() const { return present_; }
    // Returns the number of links of each kind in the latest frame.
    const std::vector<std::uint32_t>& links() const { return links_; }
    std::uint32_t exited() const { return exited_; }
    std::uint32_t passages() const { return passages_; }

private:
    struct Position {
        int lane;
        int position;
    };
    // Returns true if a vehicle passed the stop line of its lane between two successive frames.
    bool passes(const Position& before, const Position& now) const {
        const RecordedRun::RecordedLane& lane = run_.lanes[static_cast<std::size_t>(before.lane)];
        if (lane.signal_group < 0) return false;
        const auto is_past = [&](const Position& position) {
            return position.lane != before.lane || position.position * run_.grid.position_unit_m >= lane.stop_line_m;
        };
        return !is_past(before) && is_past(now);
    }

    const RecordedRun& run_;
    std::unordered_map<int, Position> last_positions_;  // [vehicle] position in the previous frame
    std::uint32_t present_ = 0;
    std::vector<std::uint32_t> links_;
    std::uint32_t exited_ = 0;
    std::uint32_t passages_ = 0;
};

// A counter of the page.
struct Counter {
    const char* id;  // of its element on the page
    const char* label;
    const char* meaning;
    bool per_hour;  // true: the page shows the increase per hour; false: the value itself
    std::uint32_t (VehicleCounter::*value)() const;
};
// All counters, in the order of the page. The first one is drawn over time as well.
constexpr std::array kCounters{
    Counter{"count-present", "in the network", "vehicles in the network", false, &VehicleCounter::present},
    Counter{"count-exited", "exited", "vehicles since the start of the recording", false, &VehicleCounter::exited},
    Counter{"flow-exits", "exits / h", "vehicles per hour, mean of the last 5 minutes", true, &VehicleCounter::exited},
    Counter{"flow-passages", "passages / h", "vehicles per hour at all stop lines, mean of the last 5 minutes", true,
            &VehicleCounter::passages}};

std::string data_element(const std::string& id, std::string_view bytes) {
    return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, encode_base64(compress_zlib(bytes)));
}

// Replaces each placeholder `@NAME@` in the template with the text of that name. The placeholders must be in the order
// of `texts`. Placeholders inside the texts are not replaced.
std::string fill_template(std::string_view text_template,
                          const std::vector<std::pair<std::string, std::string_view>>& texts) {
    std::string page;
    for (const auto& [name, text] : texts) {
        const std::size_t position = text_template.find("@" + name + "@");
        if (position == std::string_view::npos)
            throw std::logic_error("the page template has no placeholder @" + name + "@");
        page.append(text_template.substr(0, position)).append(text);
        text_template.remove_prefix(position + name.size() + 2);
    }
    return page.append(text_template);
}

std::string page_of(const RecordedRun& run, const std::string& payload, const std::string& data) {
    const std::string title =
        escape_html(fmt::format("{} {} - Stopline replay", run.origin.scenario, run.origin.population));
    std::string script;
    for (const char* const part :
         {kFile_colours_js, kFile_decode_js, kFile_network_js, kFile_map_js, kFile_time_space_js, kFile_main_js}) {
        script += part;
    }
    return fill_template(
        kFile_page_html,
        {{"TITLE", title}, {"STYLE", kFile_style_css}, {"PAYLOAD", payload}, {"DATA", data}, {"SCRIPT", script}});
}

}  // namespace

ReplayPage make_replay_page(RecordingReader& reader, const ReplayWindow& window,
                            const std::function<bool(std::int64_t)>& on_frames) {
    const RecordedRun& run = reader.run();
    ReplayPage page;
    VehicleCounter vehicles(run);
    std::string series;
    std::string data = data_element("data-head", reader.header());
    nlohmann::ordered_json payload{
        {"head", "data-head"}, {"series", "data-series"}, {"starts", nlohmann::json::array()}};
    for (const Counter& counter : kCounters) {
        payload["counters"].push_back({{"id", counter.id},
                                       {"label", counter.label},
                                       {"meaning", counter.meaning},
                                       {"per_hour", counter.per_hour}});
    }
    for (const std::string& link : run.links) {
        payload["counters"].push_back({{"id", "count-link-" + link},
                                       {"label", link + " now"},
                                       {"meaning", "vehicles at the start of a link of this kind"},
                                       {"per_hour", false}});
    }
    double recorded_until_s = run.grid.time_s(0);
    for (RecordedSection section; reader.next(section);) {
        if (on_frames && !on_frames(reader.frames())) throw Interrupted();
        const double begin_s = run.grid.time_s(section.first_frame);
        const double end_s = run.grid.time_s(section.first_frame + section.frames - 1);
        recorded_until_s = end_s;
        const bool selected = end_s >= window.from_s && begin_s <= window.until_s;
        try {
            FrameDecoder decoder(run, section.bytes);
            for (int k = 0; k < section.frames; ++k) {
                decoder.next();
                vehicles.add_frame(decoder);
                if (!selected) continue;
                for (const Counter& counter : kCounters) put_number(series, (vehicles.*counter.value)());
                for (const std::uint32_t links : vehicles.links()) put_number(series, links);
                page.max_present = std::max(page.max_present, vehicles.present());
            }
            decoder.check_end();
        } catch (const InputError& error) {
            reader.fail(
                fmt::format("the recording is damaged from frame {} on: {}", section.first_frame, error.what()));
        }
        if (!selected) continue;
        if (page.frames == 0) page.from_s = begin_s;
        page.to_s = end_s;
        data += data_element(fmt::format("data-{}", payload["starts"].size()), section.bytes);
        payload["starts"].push_back(page.frames);
        page.frames += section.frames;
        if (data.size() > kMaxBytes) {
            reader.fail(
                "the recording is too large for one page; select a part, such as --from '600 s' --until '1200 s'");
        }
    }
    if (page.frames == 0) {
        const std::string until =
            std::isfinite(window.until_s) ? fmt::format("to {:g} s", window.until_s) : std::string("on");
        reader.fail(fmt::format("the recording has no frame from {:g} s {}; it covers {:g} to {:g} s", window.from_s,
                                until, run.grid.time_s(0), recorded_until_s));
    }
    data += data_element("data-series", series);
    payload["first_s"] = page.from_s;
    // The policies of the paper have the colours that they have in the figures. The recording does not contain the
    // names of the other populations, so own policies can have another colour there.
    for (const std::string& policy : run.policies) {
        payload["policy_colours"].push_back(line_style(style_index(run.policies, policy)).colour);
    }
    page.html = page_of(run, payload.dump(), data);
    return page;
}

}  // namespace stopline
