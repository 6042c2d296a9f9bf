// The channel of Gilbert (1960, "Capacity of a burst-noise channel") with loss only in the bad state: losses come in
// bursts. A link is in a good or a bad state. From one message to the next it goes from good to bad with the
// probability p and from bad to good with the probability r. The mean burst has 1 / r messages, and the share of lost
// messages is p / (p + r). So r = 1 / burst and p = r loss / (1 - loss).
//
// The state needs no memory. One uniform draw u a message drives both states: u < p leads to the bad state from either
// state, u >= 1 - r leads to the good state from either state, and any other u leaves the state as it is. (This needs
// p <= 1 - r.) So the state is that of the latest message whose draw decides, and a receiver that asks about a message
// for the first time goes back to this draw. It goes back by 1 / (p + r) messages in the mean. A receiver that knows
// the result of the previous message need not go back.
#include <array>

#include <fmt/format.h>

#include "v2v/channel.h"

namespace stopline {

namespace {

constexpr std::array kGilbertFields{"loss", "burst"};

bool gilbert_delivers(const V2vSettings& settings, const V2vMessage& message) {
    const double r = 1.0 / settings.burst_messages;
    const double p = r * settings.loss / (1.0 - settings.loss);
    for (std::int64_t number = message.number;; --number) {
        const double draw = loss_draw(message.link_key, number);
        if (draw < p) return false;
        if (draw >= 1.0 - r) return true;
        if (message.previous != V2vMessage::Result::unknown) return message.previous == V2vMessage::Result::delivered;
    }
}

std::string gilbert_problem(const V2vSettings& settings) {
    const double most = 1.0 - 1.0 / settings.burst_messages;
    if (settings.loss <= most) return {};
    return fmt::format(
        "with bursts of {:g} messages, loss must be at most {:g} %, because losses without memory have "
        "longer bursts: use longer bursts, or channel: bernoulli",
        settings.burst_messages, 100.0 * most);
}

}  // namespace

extern const V2vChannel kGilbertChannel;
const V2vChannel kGilbertChannel{"gilbert",        "messages are lost in bursts with a mean of `burst` messages",
                                 kGilbertFields,   false,
                                 gilbert_delivers, gilbert_problem};

}  // namespace stopline
