// The losses of the V2V channels: their share, their bursts, and their independence of the order of questions.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "v2v/channel.h"
#include "v2v/plan.h"

namespace stopline {
namespace {

constexpr double kMessagesPerMinute = 600.0;  // at 10 Hz
constexpr int kSpell = 3;

struct Losses {
    double share = 0.0;
    double burst = 0.0;              // mean number of successive lost messages
    double spells_per_minute = 0.0;  // spells of at least kSpell lost messages
    double spells = 0.0;
};

Losses count_losses(const V2vSettings& settings, int links, int messages) {
    const V2vChannel& channel = find_v2v_channel(settings.channel);
    double lost = 0.0;
    double bursts = 0.0;
    Losses losses;
    for (int link = 0; link < links; ++link) {
        V2vMessage message{link_key(v2v_key(7), link, link + 1), 0, 20.0, 100.0};
        int run = 0;
        for (; message.number < messages; ++message.number) {
            if (channel.is_delivered(settings, message)) {
                run = 0;
                continue;
            }
            ++lost;
            bursts += ++run == 1 ? 1.0 : 0.0;
            losses.spells += run == kSpell ? 1.0 : 0.0;
        }
    }
    losses.share = lost / (links * messages);
    losses.burst = lost / bursts;
    losses.spells_per_minute = losses.spells * kMessagesPerMinute / (links * messages);
    return losses;
}

struct Spells {
    const char* channel;
    double loss;
    double burst;
    // Spells per minute. Bernoulli: 600 q^3 (1 - q). Gilbert: 600 loss r (1 - r)^2.
    double expected;
};

// The number of spells in a long time is about normally distributed, because spells of different links are independent.
TEST(V2vChannels, LoseAtLeastThreeMessagesInSuccessionAsOftenAsTheory) {
    for (const Spells& spells : {Spells{"bernoulli", 0.05, 1.0, 0.07}, Spells{"bernoulli", 0.10, 1.0, 0.54},
                                 Spells{"bernoulli", 0.20, 1.0, 3.8}, Spells{"gilbert", 0.05, 4.0, 4.2},
                                 Spells{"gilbert", 0.10, 4.0, 8.4}, Spells{"gilbert", 0.20, 5.0, 15.0}}) {
        SCOPED_TRACE(std::string(spells.channel) + " " + std::to_string(spells.loss));
        V2vSettings settings;
        settings.channel = spells.channel;
        settings.loss = spells.loss;
        settings.burst_messages = spells.burst;
        const bool gilbert = settings.channel == "gilbert";
        const double r = 1.0 / spells.burst;
        const double exact = gilbert ? kMessagesPerMinute * spells.loss * r * (1.0 - r) * (1.0 - r)
                                     : kMessagesPerMinute * std::pow(spells.loss, kSpell) * (1.0 - spells.loss);
        EXPECT_NEAR(exact, spells.expected, 0.06 * spells.expected) << "the closed form";
        const Losses losses = count_losses(settings, 100, 20'000);
        ASSERT_GT(losses.spells, 100.0) << "the sample is too small";
        const double band = 4.0 / std::sqrt(losses.spells);  // four standard deviations
        EXPECT_NEAR(losses.spells_per_minute, exact, band * exact);
        EXPECT_NEAR(losses.share, spells.loss, 0.03 * spells.loss);
        EXPECT_NEAR(losses.burst, gilbert ? spells.burst : 1.0 / (1.0 - spells.loss), 0.03 * losses.burst);
    }
}

// The chain of states with memory, started far in the past, has the same states as the search for the latest draw that
// decides.
TEST(V2vChannels, GilbertNeedsNoMemory) {
    V2vSettings settings;
    settings.channel = "gilbert";
    settings.loss = 0.2;
    settings.burst_messages = 20.0;
    const V2vChannel& channel = find_v2v_channel(settings.channel);
    const double r = 1.0 / settings.burst_messages;
    const double p = r * settings.loss / (1.0 - settings.loss);
    V2vMessage message{link_key(v2v_key(3), 5, 9), -2000, 20.0, 0.0};
    bool is_bad = false;
    int changes = 0;
    for (; message.number < 20'000; ++message.number) {
        const bool was_bad = is_bad;
        const double draw = loss_draw(message.link_key, message.number);
        is_bad = is_bad ? draw < 1.0 - r : draw < p;
        if (message.number < 0) continue;
        changes += was_bad != is_bad ? 1 : 0;
        ASSERT_EQ(channel.is_delivered(settings, message), !is_bad) << message.number;
    }
    EXPECT_GT(changes, 100);
}

TEST(V2vChannels, DirectionsAndLinksAreIndependent) {
    V2vSettings settings;
    settings.channel = "bernoulli";
    settings.loss = 0.5;
    const V2vChannel& channel = find_v2v_channel(settings.channel);
    constexpr int kMessages = 10'000;
    for (const auto& [sender, receiver] : {std::pair{2, 1}, std::pair{1, 3}, std::pair{3, 2}}) {
        int same = 0;
        for (int k = 0; k < kMessages; ++k) {
            const V2vMessage one{link_key(v2v_key(1), 1, 2), k, 20.0, 0.0};
            const V2vMessage other{link_key(v2v_key(1), sender, receiver), k, 20.0, 0.0};
            same += channel.is_delivered(settings, one) == channel.is_delivered(settings, other) ? 1 : 0;
        }
        EXPECT_NEAR(same, kMessages / 2, 200) << sender << " to " << receiver;
    }
}

TEST(V2vChannels, DeliveryFallsWithDistanceAndDensity) {
    V2vSettings settings;
    settings.channel = "delivery_over_distance";
    settings.delivery.curves = {{100.0, {0.0, 100.0}, {1.0, 0.8}}, {200.0, {0.0, 100.0}, {0.9, 0.5}}};
    const V2vChannel& channel = find_v2v_channel(settings.channel);
    const auto share = [&](double distance_m, double density_vpkm) {
        int delivered = 0;
        constexpr int kMessages = 20'000;
        for (int k = 0; k < kMessages; ++k) {
            delivered += channel.is_delivered(settings, {link_key(1, 2, 3), k, distance_m, density_vpkm}) ? 1 : 0;
        }
        return static_cast<double>(delivered) / kMessages;
    };
    EXPECT_NEAR(share(50.0, 100.0), 0.9, 0.01);
    EXPECT_NEAR(share(50.0, 150.0), 0.8, 0.01) << "linear between densities";
    EXPECT_NEAR(share(50.0, 200.0), 0.7, 0.01);
    EXPECT_NEAR(share(100.0, 20.0), 0.8, 0.01) << "constant below the lowest density";
    EXPECT_NEAR(share(900.0, 900.0), 0.5, 0.01) << "constant beyond both ends";
}

TEST(V2vChannels, SendersHaveDifferentPhases) {
    V2vSettings settings;
    settings.channel = "bernoulli";
    const V2vPlan plan = make_v2v_plan(settings, true, 0.02, 0.01, 1);
    ASSERT_EQ(plan.interval_ticks, 10);
    std::vector<int> count(10, 0);
    for (int vehicle = 0; vehicle < 1000; ++vehicle) ++count[static_cast<std::size_t>(first_send_tick(plan, vehicle))];
    for (const int n : count) EXPECT_NEAR(n, 100, 40);
}

TEST(V2vChannels, JitterHasItsMeanAndItsLimit) {
    for (const char* form : {"uniform", "exponential"}) {
        V2vSettings settings;
        settings.jitter_form = form;
        settings.jitter_s = 0.04;
        settings.interval_s = 0.1;
        const V2vPlan plan = make_v2v_plan(settings, true, 0.02, 0.001, 1);
        double sum = 0.0;
        constexpr int kMessages = 20'000;
        for (int k = 0; k < kMessages; ++k) {
            const int ticks = jitter_ticks(plan, link_key(1, 2, 3), k);
            EXPECT_LE(ticks, plan.longest_jitter_ticks);
            sum += ticks;
        }
        EXPECT_NEAR(sum / kMessages, plan.exponential ? 40.0 : 20.0, 1.0) << form;
    }
}

TEST(V2vChannels, UnknownNamesAreErrors) { EXPECT_THROW(find_v2v_channel("carrier_pigeon"), InputError); }

}  // namespace
}  // namespace stopline
