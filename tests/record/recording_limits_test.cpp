// Tests of the limits of recordings: a small file that would need much memory is refused at once.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/input_error.h"
#include "record/recording/bytes.h"
#include "record/recording/compression.h"
#include "record/recording/recording_format.h"
#include "record/recording/recording_reader.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

std::string section(std::string_view tag, const std::string& bytes) {
    Compressor compressor;
    const std::string packed(compressor.compress(bytes));
    std::string text(tag);
    put_number(text, static_cast<std::uint32_t>(packed.size()));
    put_number(text, static_cast<std::uint32_t>(bytes.size()));
    return text + packed;
}

// Returns a header with one member replaced.
std::string header(const std::string& member = "", const std::string& value = "") {
    std::string json =
        R"({"program":"stopline","version":"1","command":"c","scenario":"s","title":"t","scenario_hash":"0","seed":1,)"
        R"("population":"p","lane_width_m":3.5,"step_s":0.1,"frame_s":1.0,"first_frame_s":0.0,"position_unit_m":0.01,)"
        R"("speed_unit_mps":0.01,"advance_q12":100,"policies":["CDG"],"causes":["none"],"signal_groups":1,)"
        R"("lanes":[{"name":"a","length_m":100.0,"signal_group":0,"stop_line_m":100.0}]})";
    if (member.empty()) return json;
    const std::size_t begin = json.find("\"" + member + "\":") + member.size() + 3;
    return json.replace(begin, json.find_first_of(",}", begin) - begin, value);
}

class RecordingLimits : public ::testing::Test {
protected:
    // Returns the message of the error that the reader gives for a file with these sections.
    std::string refusal_of(const std::string& sections) const {
        std::string bytes(kRecordingMagic);
        put_number(bytes, kRecordingVersion);
        put_number(bytes, kByteOrderMark);
        const std::filesystem::path file = folder_.path() / "a.rec";
        std::ofstream(file, std::ios::binary) << bytes << sections;
        return input_error_of([&] {
            RecordingReader reader(file);
            RecordedSection frames;
            reader.next(frames);
        });
    }
    std::string refusal_of_header(const std::string& member, const std::string& value) const {
        return refusal_of(section(kHeadTag, header(member, value)));
    }

    TemporaryFolder folder_;
};

TEST_F(RecordingLimits, AValidHeaderIsAccepted) {
    EXPECT_TRUE(contains(refusal_of(section(kHeadTag, header())), "damaged after 0 frames: the file ends too early"));
}

TEST_F(RecordingLimits, SectionsThatUnpackToMuchMoreThanTheirSizeAreRefused) {
    const std::string zeros = section(kFramesTag, std::string(200'000'000, '\0'));
    ASSERT_LT(zeros.size(), 20'000U);
    EXPECT_TRUE(contains(refusal_of(section(kHeadTag, header()) + zeros), "to 200000000 bytes; at most 4194304 plus"));
}

TEST_F(RecordingLimits, SectionsBeyondTheFileAreRefusedBeforeTheyAreRead) {
    std::string text(kHeadTag);
    put_number(text, std::uint32_t{200'000'000});
    put_number(text, std::uint32_t{200'000'000});
    EXPECT_TRUE(contains(refusal_of(text), "the file ends too early"));
}

TEST_F(RecordingLimits, HeadersOutOfRangeAreRefused) {
    for (const auto& [member, value] :
         {std::pair{"signal_groups", "2000000000"}, std::pair{"signal_groups", "1e300"}, std::pair{"advance_q12", "-1"},
          std::pair{"seed", "-1"}, std::pair{"step_s", "1e-300"}, std::pair{"frame_s", "1e300"},
          std::pair{"first_frame_s", "-1"}, std::pair{"position_unit_m", "0"}, std::pair{"signal_group", "1"},
          std::pair{"length_m", "1e300"}}) {
        const std::string message = refusal_of_header(member, value);
        EXPECT_TRUE(contains(message, std::string("the header has a value out of range: ") + member)) << message;
    }
    const std::string deep = std::string(1000, '[') + std::string(1000, ']');
    EXPECT_TRUE(contains(refusal_of_header("causes", deep), "the header is nested too deeply"));
}

}  // namespace
}  // namespace stopline
