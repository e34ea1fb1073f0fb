// SPDX-License-Identifier: GPL-2.0-or-later
// loop_board: driver of a board that exists only in memory. Its digital output is wired to its digital input,
// its analog output (12 bit, -10 V to 10 V) to its analog input, and an encoder turns at 1000 counts/s for
// each volt, with an index every 1000 counts. Replace the struct Board by accesses to registers.
#include <millwright/canonical.hh>

namespace {

using namespace mw::sdk;

constexpr int COUNTS_PER_REV = 1000;
constexpr ConverterRange CONVERTER{
    .low = -10.0, .high = 10.0, .bit_weight = 20.0 / 4096.0, .hw_offset = -10.0};

/// The registers of the board.
struct Board {
    bool level = false;
    std::int32_t dac = 2048;
    double shaft = 0.0;  ///< [counts]
    std::int64_t index = 0;
    bool isLatching = false, isLatched = false;

    std::int32_t adc() const noexcept { return dac; }
    std::uint32_t counter() const noexcept {
        return static_cast<std::uint32_t>(static_cast<std::int64_t>(shaft)) & 0xFFFFU;
    }
    void turn(double counts) noexcept {
        const auto rev = static_cast<std::int64_t>(shaft) / COUNTS_PER_REV;
        shaft += counts;
        const auto now = static_cast<std::int64_t>(shaft) / COUNTS_PER_REV;
        if (isLatching && !isLatched && now > rev) {
            isLatched = true;
            index = now * COUNTS_PER_REV;
        }
    }
    /// A latch of an earlier request is discarded with the request.
    void latch(bool isWanted) noexcept {
        isLatched = isLatched && isWanted;
        isLatching = isWanted;
    }
};

struct LoopBoard {
    DigitalIn input;
    DigitalOut output;
    AnalogIn adc;
    AnalogOut dac;
    EncoderIn encoder;
    Board board;

    void declare(Declare &d) noexcept {
        input.declare(d, "digin-00.");
        output.declare(d, "digout-00.");
        adc.declare(d, "adcin-00.", {.bit_weight = CONVERTER.bit_weight, .hw_offset = 10.0});
        dac.declare(d, "adcout-00.", CONVERTER);
        encoder.declare(d, "encoder-00.", {.counter_bits = 16, .max_index_vel = 1e6});
        d.function<&LoopBoard::read>(this, "read");
        d.function<&LoopBoard::write>(this, "write");
    }

    void read(long period_ns) noexcept {
        board.turn(dac.write() * 1000.0 * seconds(period_ns));
        input.read(board.level);
        adc.read_code(board.adc());
        const auto index = static_cast<std::uint32_t>(board.index) & 0xFFFFU;
        encoder.read({board.counter(), board.isLatched, index}, period_ns);
    }

    void write() noexcept {
        board.level = output.write();
        board.dac = dac.write_code();
        board.latch(encoder.isIndexWanted());
    }
};

}  // namespace

MW_COMPONENT(LoopBoard, "loop_board", 8);
