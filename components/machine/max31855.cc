// SPDX-License-Identifier: GPL-2.0-or-later
// max31855: reads MAX31855 converters of type K thermocouples through bits; `personality=` gives the number
// of converters, up to 15, that share clock and select.
// Function max31855.N.bitbang-spi. `clk.out`, `cs.out` (bit) and `data.M.in` (bit) are connected to the
// converters.
// Outputs: temp-celsius.M, temp-fahrenheit.M, temp-kelvin.M (float), which keep their value during a fault;
// `fault.M` (bit) and `fault-flags.M` (u32): 1 open, 2 short to ground, 4 short to supply. Frame and slope:
// data sheet 19-5793 of Maxim Integrated. From -200 to 1350 degrees C the thermocouple's curve is corrected;
// outside this range the reading is not changed.
#include "components/machine/thermocouple.hh"
#include "hal/sdk/component.hh"

MW_PERSONALITY("converters of each instance");

namespace mw::components {
using namespace sdk;

constexpr int MAX_SENSORS = 15;
constexpr int FRAME_BITS = 32;
constexpr int REFRESH_CALLS =
    4;  ///< select stays high this long between frames, so that the converter measures again

struct Max31855Sensor {
    In<bool> data;
    Out<double> celsius, fahrenheit, kelvin;
    Out<bool> fault;
    Out<std::uint32_t> flags;
    std::uint32_t frame = 0;

    void take_frame() noexcept;
};

void Max31855Sensor::take_frame() noexcept {
    constexpr double MV_PER_DEGREE = 0.041276;
    flags = frame & 7U;
    const bool is_fault = (frame & 0x10000U) != 0 || (frame & 7U) != 0;
    fault = is_fault;
    // All bits high or all bits low means a broken wire, not a temperature.
    if (is_fault || frame == 0) {
        return;
    }
    const double linear = (static_cast<std::int32_t>(frame) >> 18) * 0.25;
    const double inside = (static_cast<std::int32_t>(frame << 16) >> 20) * 0.0625;
    const double mv = (linear - inside) * MV_PER_DEGREE + thermocouple::type_k_mv(inside);
    const double exact = thermocouple::type_k_celsius(mv);
    const double result = std::isfinite(exact) ? exact : linear;
    celsius = result;
    fahrenheit = result * 1.8 + 32.0;
    kelvin = result + 273.15;
}

struct Max31855 {
    int sensors = 0;
    Out<bool> clk, cs;
    Max31855Sensor sensor[MAX_SENSORS];
    int step = 0;

    void declare(Declare &d) noexcept {
        sensors = d.personality_number(personality[d.index()], 0, MAX_SENSORS, "converters");
        d.pin(cs, "cs.out");
        d.pin(clk, "clk.out");
        for (int i = 0; i < sensors; ++i) {
            d.pin_at(sensor[i].data, "data.%d.in", i);
            d.pin_at(sensor[i].celsius, "temp-celsius.%d", i);
            d.pin_at(sensor[i].fahrenheit, "temp-fahrenheit.%d", i);
            d.pin_at(sensor[i].kelvin, "temp-kelvin.%d", i);
            d.pin_at(sensor[i].fault, "fault.%d", i);
            d.pin_at(sensor[i].flags, "fault-flags.%d", i);
        }
        d.function<&Max31855::update>(this, "bitbang-spi");
    }

    /// Select goes low; then for each bit the data is read, the clock goes high and the clock goes low.
    void update() noexcept {
        const int bit_steps = step - REFRESH_CALLS;
        if (bit_steps < 0) {
            cs = true;
            clk = false;
            ++step;
        } else if (bit_steps == 0) {
            cs = false;
            ++step;
        } else if (bit_steps % 2 == 1) {
            for (int i = 0; i < sensors; ++i) {
                sensor[i].frame = sensor[i].frame << 1 | (sensor[i].data ? 1U : 0U);
            }
            clk = true;
            ++step;
        } else {
            clk = false;
            ++step;
            if (bit_steps / 2 >= FRAME_BITS) {
                finish_frame();
            }
        }
    }

  private:
    void finish_frame() noexcept {
        for (int i = 0; i < sensors; ++i) {
            sensor[i].take_frame();
        }
        cs = true;
        step = 0;
    }
};

}  // namespace mw::components

MW_COMPONENT(mw::components::Max31855, "max31855", mw::sdk::MANY);
