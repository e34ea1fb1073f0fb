// SPDX-License-Identifier: GPL-2.0-or-later
// latency: a histogram of the regularity of a thread, for latency-test and latency-histogram.
// `count=` instances (1 to 4, default 2), one for each thread; `bin=` width of a bin of each [ns]. Function
// latency.N. Pins: last, min, max (s32, out: intervals between two calls [ns]), jitter (s32, out: largest
// deviation from the period [ns]), reset (bit, in: restart while true).
#include "hal/sdk/component.hh"
#include "hal/tools/view/latency_block.hh"

static int count = 2;
RTAPI_MP_INT(count, "number of threads to measure");
static int bin[mw::hal::view::LATENCY_THREADS];
RTAPI_MP_ARRAY_INT(bin, mw::hal::view::LATENCY_THREADS, "width of a bin of each [ns]");

namespace mw::components {
using namespace sdk;

namespace {
constexpr int DEFAULT_BIN_NS = 1000;
}

struct Latency {
    Out<std::int32_t> last, min, max, jitter;
    In<bool> reset;
    hal::view::LatencySlot *slot = nullptr;
    std::int64_t bin_ns = DEFAULT_BIN_NS;
    long long last_call_ns = 0;
    bool has_last = false;

    void declare(Declare &d) noexcept {
        d.pin(last, "last");
        d.pin(min, "min");
        d.pin(max, "max");
        d.pin(jitter, "jitter");
        d.pin(reset, "reset");
        d.function<&Latency::update>(this);
    }

    void begin(long period_ns) noexcept {
        constexpr auto RELAXED = std::memory_order_relaxed;
        slot->period_ns.store(period_ns, RELAXED);
        slot->bin_ns.store(bin_ns, RELAXED);
        slot->intervals.store(0, RELAXED);
        slot->sum_ns.store(0.0, RELAXED);
        slot->sum_squares_ns2.store(0.0, RELAXED);
        slot->below.store(0, RELAXED);
        slot->above.store(0, RELAXED);
        for (auto &one : slot->bins) {
            one.store(0, RELAXED);
        }
    }

    void update(long period_ns) noexcept {
        const long long now_ns = rtapi_get_time();
        if (reset || !has_last) {
            begin(period_ns);
        } else {
            const long long interval_ns = now_ns - last_call_ns;
            hal::view::count_interval(*slot, interval_ns);
            show(interval_ns, period_ns);
        }
        last_call_ns = now_ns;
        has_last = true;
    }

    void show(long long interval_ns, long period_ns) noexcept {
        constexpr auto RELAXED = std::memory_order_relaxed;
        const std::int64_t low = slot->min_ns.load(RELAXED), high = slot->max_ns.load(RELAXED);
        const std::int64_t early = period_ns - low, late = high - period_ns;
        last = clamped(interval_ns);
        min = clamped(low);
        max = clamped(high);
        jitter = clamped(early > late ? early : late);
    }

    static std::int32_t clamped(std::int64_t value) noexcept {
        return value > INT32_MAX ? INT32_MAX : static_cast<std::int32_t>(value);
    }
};

}  // namespace mw::components

static int mw_comp_id = -1;
static int mw_shmem_id = -1;

static int load_latency(int comp_id) {
    using namespace mw::components;
    using mw::hal::view::LatencyBlock;
    if (count < 1 || count > mw::hal::view::LATENCY_THREADS) {
        rtapi_print_msg(RTAPI_MSG_ERR, "latency: count=%d is out of range, 1 to %d are possible", count,
                        mw::hal::view::LATENCY_THREADS);
        return -EINVAL;
    }
    mw_shmem_id = rtapi_shmem_new(mw::hal::view::LATENCY_KEY, comp_id, sizeof(LatencyBlock));
    void *memory = nullptr;
    if (mw_shmem_id < 0 || rtapi_shmem_getptr(mw_shmem_id, &memory) < 0) {
        return -ENOMEM;
    }
    auto *block = static_cast<LatencyBlock *>(memory);
    block->magic = mw::hal::view::LATENCY_MAGIC;
    for (int i = 0; i < count; ++i) {
        auto *latency = make<Latency>();
        if (latency == nullptr) {
            return -ENOMEM;
        }
        if (bin[i] < 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "latency: bin=%d is no width", bin[i]);
            return -EINVAL;
        }
        latency->slot = &block->slots[i];
        latency->bin_ns = bin[i] > 0 ? bin[i] : DEFAULT_BIN_NS;
        Name prefix;
        rtapi_snprintf(prefix.text, sizeof prefix.text, "latency.%d", i);
        Declare declare(comp_id, prefix.text, i);
        latency->declare(declare);
        if (declare.status() < 0) {
            return declare.status();
        }
    }
    return 0;
}

int rtapi_app_main(void) {
    mw_comp_id = hal_init("latency");
    if (mw_comp_id < 0) {
        return mw_comp_id;
    }
    mw_comp_id = mw::sdk::finish(mw_comp_id, load_latency(mw_comp_id));
    return mw_comp_id < 0 ? mw_comp_id : 0;
}

void rtapi_app_exit(void) {
    rtapi_shmem_delete(mw_shmem_id, mw_comp_id);
    hal_exit(mw_comp_id);
}
