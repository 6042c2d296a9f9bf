// V2V channels. A channel decides whether a message from one vehicle reaches another vehicle. A new channel is one file
// with a V2vChannel and one line in channels.cpp.
//
// A decision depends only on the key of the link and on the number of the message, never on earlier decisions. The
// result therefore does not depend on threads, the order of vehicles, or the step in which a receiver asks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "base/random.h"
#include "driver/v2v_settings.h"

namespace stopline {

// A message from one vehicle to another one.
struct V2vMessage {
    enum class Result : std::uint8_t { unknown, lost, delivered };
    std::uint64_t link_key = 0;  // random key of the sender and the receiver, see link_key()
    std::int64_t number = 0;     // the sender numbers its messages; every receiver gets the same number
    double distance_m = 0.0;     // from the receiver to the sender when the message arrives
    double density_vpkm = 0.0;   // vehicles per km of road around the link; only if the channel reads it
    // Result of the message with the previous number on this link. A receiver that does not know it leaves `unknown`.
    Result previous = Result::unknown;
};

struct V2vChannel {
    const char* name;
    const char* meaning;
    std::span<const char* const>
        fields;          // fields of `driver.v2v` that the channel reads, besides those of all channels
    bool reads_density;  // true: V2vMessage::density_vpkm must be set
    // Returns true if the receiver gets the message. nullptr: every message arrives.
    bool (*is_delivered)(const V2vSettings& settings, const V2vMessage& message);
    // Returns what is wrong with the settings, or an empty text. nullptr: nothing can be wrong.
    std::string (*problem)(const V2vSettings& settings);
};

std::span<const V2vChannel* const> v2v_channels();
// Adds a channel that is not in the list of channels.cpp. For tests.
void register_v2v_channel(const V2vChannel& channel);
// Throws InputError if there is no channel of that name.
const V2vChannel& find_v2v_channel(const std::string& name);
std::vector<std::string> v2v_channel_names();

// Returns the random key of a link. `run_key`: v2v_key() of the seed. Both directions of a link differ.
constexpr std::uint64_t link_key(std::uint64_t run_key, int sender, int receiver) {
    const auto word = [](int id) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(id)); };
    return mix64(run_key ^ (word(sender) << 32 | word(receiver)));
}
// Returns a uniform number in [0, 1) for a message of a link. The number decides about the loss of the message.
inline double loss_draw(std::uint64_t link, std::int64_t number) {
    return static_cast<double>(mix64(link ^ static_cast<std::uint64_t>(number)) >> 11) * 0x1.0p-53;
}
// Returns another uniform number for the same message. This number decides about its delay.
inline double delay_draw(std::uint64_t link, std::int64_t number) { return loss_draw(mix64(link), number); }

}  // namespace stopline
