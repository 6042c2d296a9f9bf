#include "replay/page.h"

#include <algorithm>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "experiment/interrupted.h"
#include "record/bytes.h"
#include "record/frame_decoder.h"
#include "replay/packing.h"
#include "replay_page_files.h"

namespace stopline {

namespace {

constexpr std::size_t kMostBytes = 400'000'000;  // browsers refuse strings of about 500 MB

// Where every vehicle was in the frame before, and what has been counted since the recording began.
class Counter {
public:
    explicit Counter(const RecordedRun& run) : run_(run) {}

    void look(const FrameDecoder& frame) {
        present_ = 0;
        entered_ += frame.entered();
        left_ += frame.left();
        std::unordered_map<int, Place> now;
        for (const RecordedVehicle& one : frame.seats()) {
            if (one.vehicle < 0) continue;
            ++present_;
            const Place place{one.lane, one.position};
            const auto before = before_.find(one.vehicle);
            if (before != before_.end() && passes(before->second, place)) ++passed_;
            now.emplace(one.vehicle, place);
        }
        before_ = std::move(now);
    }

    std::uint32_t present() const { return present_; }
    void append_to(std::string& series) const {
        put_number(series, present_);
        for (const std::int64_t count : {entered_, left_, passed_}) {
            put_number(series, static_cast<std::uint32_t>(count));
        }
    }

private:
    struct Place {
        int lane;
        int position;
    };
    bool passes(const Place& before, const Place& now) const {
        const RecordedRun::RecordedLane& lane = run_.lanes[static_cast<std::size_t>(before.lane)];
        if (lane.signal_group < 0) return false;
        const auto is_past = [&](const Place& place) {
            return place.lane != before.lane || place.position * run_.grid.position_unit_m >= lane.stop_line_m;
        };
        return !is_past(before) && is_past(now);
    }

    const RecordedRun& run_;
    std::unordered_map<int, Place> before_;  // by vehicle
    std::uint32_t present_ = 0;
    std::int64_t entered_ = 0;
    std::int64_t left_ = 0;
    std::int64_t passed_ = 0;
};

std::string data_element(const std::string& id, std::string_view bytes) {
    return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64(deflated(bytes)));
}

std::string escaped(const std::string& text) {
    std::string html;
    for (const char c : text) html += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return html;
}

// `@NAME@` in the template becomes each text; texts are not looked through again.
std::string filled(std::string_view form, const std::vector<std::pair<std::string, std::string_view>>& texts) {
    std::string page;
    for (const auto& [name, text] : texts) {
        const std::size_t place = form.find("@" + name + "@");
        if (place == std::string_view::npos) throw std::logic_error("the page has no place for " + name);
        page.append(form.substr(0, place)).append(text);
        form.remove_prefix(place + name.size() + 2);
    }
    return page.append(form);
}

std::string page_of(const RecordedRun& run, const std::string& payload, const std::string& data) {
    const std::string title =
        escaped(fmt::format("{} {} - Stopline replay", run.origin.scenario, run.origin.population));
    std::string script;
    for (const char* const part :
         {kFile_colours_js, kFile_decode_js, kFile_network_js, kFile_map_js, kFile_time_space_js, kFile_main_js}) {
        script += part;
    }
    return filled(
        kFile_page_html,
        {{"TITLE", title}, {"STYLE", kFile_style_css}, {"PAYLOAD", payload}, {"DATA", data}, {"SCRIPT", script}});
}

}  // namespace

ReplayPage make_replay_page(RecordingReader& reader, const ReplayWindow& window,
                            const std::function<bool(std::int64_t)>& on_frames) {
    const RecordedRun& run = reader.run();
    ReplayPage page;
    Counter counter(run);
    std::string series;
    std::string data = data_element("data-head", reader.header());
    nlohmann::ordered_json payload{
        {"head", "data-head"}, {"series", "data-series"}, {"starts", nlohmann::json::array()}};
    for (RecordedSection section; reader.next(section);) {
        if (on_frames && !on_frames(reader.frames())) throw Interrupted();
        const double begin_s = run.grid.time_s(section.first_frame);
        const double end_s = run.grid.time_s(section.first_frame + section.frames - 1);
        const bool taken = end_s >= window.from_s && begin_s <= window.until_s;
        try {
            FrameDecoder decoder(run, section.bytes);
            for (int k = 0; k < section.frames; ++k) {
                decoder.next();
                counter.look(decoder);
                if (!taken) continue;
                counter.append_to(series);
                page.most_present = std::max(page.most_present, counter.present());
            }
            decoder.check_end();
        } catch (const InputError& error) {
            reader.fail(fmt::format("damaged in the frames from {} on: {}", section.first_frame, error.what()));
        }
        if (!taken) continue;
        if (page.frames == 0) page.from_s = begin_s;
        page.to_s = end_s;
        data += data_element(fmt::format("data-{}", payload["starts"].size()), section.bytes);
        payload["starts"].push_back(page.frames);
        page.frames += section.frames;
        if (data.size() > kMostBytes) {
            reader.fail("too long for one page: show a part of it with --from '600 s' --until '1200 s'");
        }
    }
    if (page.frames == 0) {
        reader.fail(fmt::format("it has no frame from {:g} to {:g} s", window.from_s, window.until_s));
    }
    data += data_element("data-series", series);
    payload["first_s"] = page.from_s;
    page.html = page_of(run, payload.dump(), data);
    return page;
}

}  // namespace stopline
