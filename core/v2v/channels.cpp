// The list of V2V channels.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/defined_elsewhere.h"
#include "base/input_error.h"
#include "v2v/channel.h"

namespace stopline {

// Returns the channels. The order is the order in lists for the user.
static std::vector<const V2vChannel*>& channels() {
    static std::vector<const V2vChannel*> all{
        // NOLINTBEGIN(readability-identifier-naming): the macro declares constants of the namespace inside a function.
        STOPLINE_DEFINED_ELSEWHERE(V2vChannel, kIdealChannel),
        STOPLINE_DEFINED_ELSEWHERE(V2vChannel, kBernoulliChannel),
        STOPLINE_DEFINED_ELSEWHERE(V2vChannel, kGilbertChannel),
        STOPLINE_DEFINED_ELSEWHERE(V2vChannel, kDeliveryChannel),
        // NOLINTEND(readability-identifier-naming)
    };
    return all;
}

std::span<const V2vChannel* const> v2v_channels() { return channels(); }

void register_v2v_channel(const V2vChannel& channel) { channels().push_back(&channel); }

const V2vChannel& find_v2v_channel(const std::string& name) {
    for (const V2vChannel* channel : channels()) {
        if (name == channel->name) return *channel;
    }
    throw InputError(
        fmt::format("there is no V2V channel '{}'; the channels are: {}", name, fmt::join(v2v_channel_names(), ", ")));
}

std::vector<std::string> v2v_channel_names() {
    std::vector<std::string> names;
    for (const V2vChannel* channel : channels()) names.emplace_back(channel->name);
    return names;
}

}  // namespace stopline
