// SPDX-License-Identifier: GPL-2.0-or-later
// plant_encoder: a position encoder with its counter, which may lose counts or find some.
#include "components/plants/encoder.hh"
#include "hal/sdk/component.hh"

namespace mw::components {
using namespace sdk;

struct PlantEncoder {
    In<double> shaft, counts_per_unit, index_spacing, index_at, jump_by;
    In<bool> lost, jump;
    InOut<bool> index_enable;
    Out<double> position, zero;
    plants::Encoder encoder;
    bool was_jumping = false;

    void declare(Declare &d) noexcept {
        d.pin(shaft, "shaft");
        d.pin(counts_per_unit, "counts-per-unit", plants::EncoderSettings{}.counts_per_unit);
        d.pin(index_spacing, "index-spacing");
        d.pin(index_at, "index-at");
        d.pin(lost, "lost");
        d.pin(jump, "jump");
        d.pin(jump_by, "jump-by");
        d.pin(index_enable, "index-enable");
        d.pin(position, "position");
        d.pin(zero, "zero");
        d.function<&PlantEncoder::update>(this);
    }
    void update() noexcept {
        if (counts_per_unit > 0) {
            encoder.set({counts_per_unit, index_spacing, index_at});
        }
        encoder.lose(lost);
        if (jump && !was_jumping) {
            encoder.jump(jump_by);
        }
        was_jumping = jump;
        if (encoder.run(shaft, index_enable)) {
            index_enable = false;
        }
        position = encoder.reading();
        zero = encoder.zero();
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::PlantEncoder, "plant_encoder", mw::sdk::MANY);
