// SPDX-License-Identifier: GPL-2.0-or-later
// weighted_sum: numbers made of bits. `wsum_sizes=2,4,...` makes up to 8 sums of 1 to 16 bits.
//
// `wsum.N.sum` (s32) is `wsum.N.offset` plus the `wsum.N.bit.M.weight` (s32, 2^M at start) of each
// `wsum.N.bit.M.in` (bit) that is true; it does not change while `wsum.N.hold` (bit) is true. One function
// `process_wsums` for all.
#include "hal/sdk/component.hh"

constexpr int MAX_SUMS = 8;
static int wsum_sizes[MAX_SUMS];
RTAPI_MP_ARRAY_INT(wsum_sizes, MAX_SUMS, "bits of each sum");

namespace mw::components {
using namespace sdk;

constexpr int MAX_BITS = 16;

struct WeightedSum {
    int size = 0;
    In<bool> in[MAX_BITS];
    InOut<std::int32_t> weight[MAX_BITS];
    In<bool> hold;
    InOut<std::int32_t> offset;
    Out<std::int32_t> sum;

    void declare(Declare &d) noexcept {
        for (int i = 0; i < size; ++i) {
            d.pin_at(in[i], "bit.%d.in", i);
            d.pin_at(weight[i], "bit.%d.weight", i, 1 << i);
        }
        d.pin(hold, "hold");
        d.pin(offset, "offset");
        d.pin(sum, "sum");
    }

    void update() noexcept {
        if (hold) {
            return;
        }
        std::uint32_t total = static_cast<std::uint32_t>(offset.get());
        for (int i = 0; i < size; ++i) {
            total += in[i] ? static_cast<std::uint32_t>(weight[i].get()) : 0U;
        }
        sum = static_cast<std::int32_t>(total);
    }
};

struct WeightedSums {
    int count = 0;
    WeightedSum *sum[MAX_SUMS] = {};

    int load(int comp_id) noexcept {
        for (; count < MAX_SUMS && wsum_sizes[count] != 0; ++count) {
            const int size = wsum_sizes[count];
            if (size < 1 || size > MAX_BITS) {
                rtapi_print_msg(RTAPI_MSG_ERR, "weighted_sum: wsum_sizes has %d, but a sum has 1 to %d bits",
                                size, MAX_BITS);
                return -EINVAL;
            }
            sum[count] = make<WeightedSum>();
            if (sum[count] == nullptr) {
                return -ENOMEM;
            }
            sum[count]->size = size;
            Name prefix;
            rtapi_snprintf(prefix.text, sizeof prefix.text, "wsum.%d", count);
            Declare d(comp_id, prefix.text, count);
            sum[count]->declare(d);
            if (d.status() < 0) {
                return d.status();
            }
        }
        if (count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "weighted_sum: wsum_sizes= is missing, for example wsum_sizes=4");
            return -EINVAL;
        }
        Declare d(comp_id, "process_wsums", 0);
        d.function<&WeightedSums::update>(this);
        return d.status();
    }

    void update() noexcept {
        for (int i = 0; i < count; ++i) {
            sum[i]->update();
        }
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::WeightedSums, "weighted_sum");
