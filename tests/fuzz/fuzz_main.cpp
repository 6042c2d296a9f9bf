// The entry points that libFuzzer calls. STOPLINE_FUZZ_TARGET is the name of the target of this program.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "fuzz/mutators.h"
#include "fuzz/targets.h"

using stopline::fuzz::Random;
using stopline::fuzz::Target;
using stopline::fuzz::target;

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed);

namespace {

const Target& own_target() {
    static const Target& own = target(STOPLINE_FUZZ_TARGET);
    return own;
}

void mutate_bytes(std::string& text) {
    constexpr std::size_t kGrowth = 256;
    std::string buffer = text;
    buffer.resize(text.size() + kGrowth);
    const std::size_t size =
        LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(buffer.data()), text.size(), buffer.size());
    text = buffer.substr(0, size);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    own_target().run({reinterpret_cast<const char*>(data), size});
    return 0;
}

// Two of three changes keep the structure; the others change bytes.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned seed) {
    Random random(seed);
    if (own_target().mutate == nullptr || random.below(3) == 0) return LLVMFuzzerMutate(data, size, max_size);
    std::string text(reinterpret_cast<const char*>(data), size);
    own_target().mutate(text, random, mutate_bytes);
    if (text.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
    std::memcpy(data, text.data(), text.size());
    return text.size();
}
