// A channel that loses each message with the same probability, independently of all others.
#include <array>

#include "v2v/channel.h"

namespace stopline {

namespace {

constexpr std::array kBernoulliFields{"loss"};

bool bernoulli_delivers(const V2vSettings& settings, const V2vMessage& message) {
    return loss_draw(message.link_key, message.number) >= settings.loss;
}

}  // namespace

extern const V2vChannel kBernoulliChannel;
const V2vChannel kBernoulliChannel{"bernoulli",        "each message is lost with the probability `loss`",
                                   kBernoulliFields,   false,
                                   bernoulli_delivers, nullptr};

}  // namespace stopline
