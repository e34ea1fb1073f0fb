// SPDX-License-Identifier: GPL-2.0-or-later
// capture: records up to 16 pins, signals or parameters around a trigger, for `millwright hal capture`.
//
// `depth=` words of memory (default 1048576): a sample of N channels takes N + 1. Function capture.sample;
// parameters none. Pins: state (u32, out: 0 idle, 1 filling, 2 waiting for the trigger, 3 triggered, 4 done,
// 5 rejected) and recorded (u32, out: samples so far).
#include <cstring>

#include "components/look/capture_core.hh"
#include "hal/sdk/component.hh"

static int depth = 1 << 20;
RTAPI_MP_INT(depth, "memory for a record [words of 8 bytes]");

namespace mw::components {
using namespace sdk;

namespace {

constexpr int MOST_WORDS = 1 << 24;

/// The word at an address in HAL memory.
std::uint64_t word_at(const char *place, std::uint32_t type) noexcept {
    switch (type) {
    case HAL_BIT: return *reinterpret_cast<const volatile bool *>(place) ? 1U : 0U;
    case HAL_S32:
    case HAL_U32:
    case HAL_PORT: return *reinterpret_cast<const volatile std::uint32_t *>(place);
    default: return *reinterpret_cast<const volatile std::uint64_t *>(place);
    }
}

double number_of(std::uint64_t word, std::uint32_t type) noexcept {
    switch (type) {
    case HAL_FLOAT: {
        double value = 0.0;
        std::memcpy(&value, &word, sizeof value);
        return value;
    }
    case HAL_S32: return static_cast<std::int32_t>(static_cast<std::uint32_t>(word));
    case HAL_S64: return static_cast<double>(static_cast<std::int64_t>(word));
    default: return static_cast<double>(word);
    }
}

}  // namespace

struct Capture {
    Out<std::uint32_t> state, recorded;
    hal::view::CaptureBlock *block = nullptr;
    CaptureCore core;

    void declare(Declare &d) noexcept {
        d.pin(state, "state");
        d.pin(recorded, "recorded");
        d.function<&Capture::sample>(this, "sample");
    }

    void sample() noexcept {
        const auto word = [this](std::uint32_t channel) noexcept {
            const hal::view::CaptureChannel &source = core.settings().channel[channel];
            return word_at(reinterpret_cast<const char *>(block) + source.offset, source.type);
        };
        const auto number = [this](std::uint32_t channel, std::uint64_t bits) noexcept {
            return number_of(bits, core.settings().channel[channel].type);
        };
        core.step(*block, rtapi_get_time(), word, number);
        state = static_cast<std::uint32_t>(block->state.load(std::memory_order_relaxed));
        recorded = block->recorded.load(std::memory_order_relaxed);
    }
};

}  // namespace mw::components

static int mw_comp_id = -1;
static int mw_shmem_id = -1;

static int load_capture(int comp_id) {
    using mw::hal::view::CaptureBlock;
    if (depth < 2 || depth > mw::components::MOST_WORDS) {
        rtapi_print_msg(RTAPI_MSG_ERR, "capture: depth=%d is out of range, 2 to %d are possible", depth,
                        mw::components::MOST_WORDS);
        return -EINVAL;
    }
    const unsigned long size =
        sizeof(CaptureBlock) + static_cast<unsigned long>(depth) * sizeof(std::uint64_t);
    mw_shmem_id = rtapi_shmem_new(mw::hal::view::CAPTURE_KEY, comp_id, size);
    void *memory = nullptr;
    if (mw_shmem_id < 0 || rtapi_shmem_getptr(mw_shmem_id, &memory) < 0) {
        return -ENOMEM;
    }
    auto *capture = mw::sdk::make<mw::components::Capture>();
    if (capture == nullptr) {
        return -ENOMEM;
    }
    capture->block = static_cast<CaptureBlock *>(memory);
    capture->block->magic = mw::hal::view::CAPTURE_MAGIC;
    capture->block->capacity = static_cast<std::uint32_t>(depth);
    mw::sdk::Declare declare(comp_id, "capture", 0);
    capture->declare(declare);
    return declare.status();
}

int rtapi_app_main(void) {
    mw_comp_id = hal_init("capture");
    if (mw_comp_id < 0) {
        return mw_comp_id;
    }
    mw_comp_id = mw::sdk::finish(mw_comp_id, load_capture(mw_comp_id));
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    rtapi_shmem_delete(mw_shmem_id, mw_comp_id);
    hal_exit(mw_comp_id);
}
