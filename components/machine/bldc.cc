// SPDX-License-Identifier: GPL-2.0-or-later
// bldc: commutation of three-phase motors from hall sensors, encoders or nothing. `cfg=` is a list of up to 8
// instances, each made of letters. The manual page describes all pins.
#include <cmath>

#include "components/logic/gray.hh"
#include "components/machine/bldc_core.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_MOTORS = 8;
static char *cfg[MAX_MOTORS];
RTAPI_MP_ARRAY_STRING(cfg, MAX_MOTORS, "feedback and outputs of each motor, such as qi6");

namespace mw::components {
using namespace sdk;

enum BldcTag : unsigned {
    HALL = 0x01,
    ABSOLUTE = 0x02,
    QUADRATURE = 0x04,
    INDEX = 0x08,
    FANUC = 0x10,
    BITS_OUT = 0x100,
    SIX_OUT = 0x200,
    HALL_OUT = 0x400,
    FANUC_OUT = 0x800,
    TRAPEZOID = 0x1000
};
constexpr unsigned PHASE_OUTPUTS = BITS_OUT | SIX_OUT | HALL_OUT | FANUC_OUT;
constexpr double ALIGN_TURN_S = 1.0;  ///< time during which the field turns
constexpr double ALIGN_HOLD_S = 1.0;  ///< time during which the field then does not move

enum class BldcHoming : std::int32_t { NONE, ALIGNING, SEARCHING, DONE };

struct Bldc {
    unsigned tags = 0;
    In<bool> hall[3], fanuc[4], rev, init;
    In<double> value, lead_angle, frequency, initvalue;
    In<std::int32_t> rawcounts;
    InOut<bool> index_enable;
    Out<bool> hall_error, init_done, on[6], hall_out[3], fanuc_out[4], out_dir;
    Out<double> phase_out[6], phase_angle, rotor_angle, out, out_abs;
    ParamRo<std::int32_t> in_type, out_type, offset_measured;
    ParamRw<std::int32_t> scale, poles, encoder_offset;
    ParamRw<double> drive_offset;
    ParamRw<std::uint32_t> output_pattern, pattern;

    double rotor = 0.0;
    double field = 0.0;  // while homing
    double waited_s = 0.0;
    int sector = -1;
    std::int32_t last_counts = 0;
    std::int32_t zero_counts = 0;
    bool last_init = false;
    bool last_index = false;
    bool aligned = false;
    BldcHoming homing = BldcHoming::NONE;

    void declare(Declare &d) noexcept;
    void update(long period_ns) noexcept;

  private:
    bool has(unsigned tag) const noexcept { return (tags & tag) != 0; }
    void declare_inputs(Declare &d) noexcept;
    void declare_outputs(Declare &d) noexcept;
    void declare_params(Declare &d) noexcept;
    double counts_per_turn() const noexcept;
    void read_hall() noexcept;
    void read_encoder() noexcept;
    void run_homing(double dt) noexcept;
    void write(double phase, int commuted, double size) noexcept;
    void write_codes(double phase) noexcept;
};

void Bldc::declare_inputs(Declare &d) noexcept {
    if (has(HALL)) {
        for (int i = 0; i < 3; ++i) {
            d.pin_at(hall[i], "hall%d", i + 1);
        }
        d.pin(hall_error, "hall-error");
    }
    if (has(FANUC)) {
        for (int i = 0; i < 4; ++i) {
            char name[8];
            char legacy[8];
            rtapi_snprintf(name, sizeof name, "c%d", 1 << i);
            rtapi_snprintf(legacy, sizeof legacy, "C%d", 1 << i);
            d.legacy_pin(fanuc[i], name, legacy);
        }
    }
    d.pin(value, "value");
    d.pin(rev, "rev");
    if (has(ABSOLUTE | QUADRATURE)) {
        d.pin(lead_angle, "lead-angle", 90.0);
        d.pin(rawcounts, "rawcounts");
    }
    if (!has(HALL | ABSOLUTE | QUADRATURE | INDEX)) {
        d.pin(frequency, "frequency");
    }
    if (has(QUADRATURE)) {
        d.pin(initvalue, "initvalue", 0.2);
    }
    if (has(INDEX)) {
        d.pin(index_enable, "index-enable");
    }
    if (has(QUADRATURE) && !has(HALL)) {
        d.pin(init, "init");
        d.pin(init_done, "init-done");
    }
}

void Bldc::declare_outputs(Declare &d) noexcept {
    constexpr char LETTER[] = {'A', 'B', 'C'};
    const unsigned kind = tags & PHASE_OUTPUTS;
    const bool is_six = kind == SIX_OUT || kind == (SIX_OUT | BITS_OUT);
    const bool is_three = kind == 0 || kind == BITS_OUT;
    for (int i = 0; i < 6 && (is_six || (is_three && i < 3)); ++i) {
        const char *half = !is_six ? "" : (i < 3 ? "-high" : "-low");
        const char *tail = kind == 0 ? "-value" : (has(BITS_OUT) ? "-on" : "");
        char name[24];
        char legacy[24];
        rtapi_snprintf(legacy, sizeof legacy, "%c%s%s", LETTER[i % 3], half, tail);
        rtapi_snprintf(name, sizeof name, "%c%s%s", LETTER[i % 3] | 0x20, half, tail);
        if (has(BITS_OUT)) {
            d.legacy_pin(on[i], name, legacy);
        } else {
            d.legacy_pin(phase_out[i], name, legacy);
        }
    }
    for (int i = 0; i < 3 && has(HALL_OUT); ++i) {
        d.pin_at(hall_out[i], "hall%d-out", i + 1);
    }
    for (int i = 0; i < 4 && has(FANUC_OUT); ++i) {
        char name[16];
        char legacy[16];
        rtapi_snprintf(name, sizeof name, "c%d-out", 1 << i);
        rtapi_snprintf(legacy, sizeof legacy, "C%d-out", 1 << i);
        d.legacy_pin(fanuc_out[i], name, legacy);
    }
    d.pin(phase_angle, "phase-angle");
    d.pin(rotor_angle, "rotor-angle");
    d.pin(out, "out");
    d.pin(out_dir, "out-dir");
    d.pin(out_abs, "out-abs");
}

void Bldc::declare_params(Declare &d) noexcept {
    d.param(in_type, "in-type", -1);
    d.param(out_type, "out-type", -1);
    if (has(ABSOLUTE | QUADRATURE)) {
        d.param(scale, "scale", 512);
        d.param(poles, "poles", 4);
    }
    if (has(ABSOLUTE | INDEX)) {
        d.param(encoder_offset, "encoder-offset");
    }
    if (has(QUADRATURE)) {
        d.param(offset_measured, "offset-measured");
    }
    d.param(drive_offset, "drive-offset");
    if (has(HALL_OUT)) {
        d.param(output_pattern, "output-pattern", 25U);
    }
    if (has(HALL)) {
        d.param(pattern, "pattern", 25U);
    }
}

void Bldc::declare(Declare &d) noexcept {
    declare_inputs(d);
    declare_outputs(d);
    declare_params(d);
    d.function<&Bldc::update>(this);
}

double Bldc::counts_per_turn() const noexcept {
    const double turns = poles > 1 ? poles / 2.0 : 1.0;
    return scale != 0 ? scale / turns : 1.0;
}

void Bldc::read_hall() noexcept {
    const unsigned state = (hall[0] ? 4U : 0U) | (hall[1] ? 2U : 0U) | (hall[2] ? 1U : 0U);
    const std::uint32_t wanted = pattern;
    const int number = wanted < bldc::PATTERNS ? static_cast<int>(wanted) : 0;
    const int now = bldc::sector_of_hall(number, state);
    const bool moved = now >= 0 && sector >= 0 && now != sector;
    const int step = moved ? (now - sector + bldc::SECTORS) % bldc::SECTORS : 0;
    if (now < 0 || wanted >= bldc::PATTERNS || (step != 0 && step != 1 && step != bldc::SECTORS - 1)) {
        hall_error = true;
    } else if (step != 0) {
        hall_error = false;
        // The edge between the two sectors is the present position of the rotor.
        const int later = step == 1 ? now : sector;
        if (has(QUADRATURE) && !has(INDEX) && !aligned) {
            const double edge = (later + 0.5) / bldc::SECTORS;
            zero_counts = rawcounts - static_cast<std::int32_t>(std::lround(edge * counts_per_turn()));
            offset_measured = zero_counts;
            aligned = true;
        }
    }
    sector = now;
    if (now >= 0 && !aligned) {
        rotor = bldc::fraction((now + 1.0) / bldc::SECTORS);
    }
}

/// The rotor angle from the counts, plus half of the movement since the last period: this is the angle in the
/// middle of the next period.
void Bldc::read_encoder() noexcept {
    const std::int32_t counts = rawcounts;
    const bool is_index = has(INDEX) && last_index && !index_enable;
    if (is_index && !has(ABSOLUTE)) {
        zero_counts = counts + encoder_offset;
        offset_measured = zero_counts;
        aligned = true;
    }
    const std::int32_t zero = has(ABSOLUTE) ? encoder_offset.get() : zero_counts;
    if (has(ABSOLUTE) || aligned) {
        const double ahead = 0.5 * (static_cast<double>(counts) - last_counts);
        rotor = bldc::fraction((static_cast<double>(counts) - zero + ahead) / counts_per_turn());
    }
    last_counts = counts;
}

/// Without hall sensors: rotates the field until the index is found, or to zero, and sets this as the angle
/// of the rotor.
void Bldc::run_homing(double dt) noexcept {
    const bool is_init = init;
    if (is_init && !last_init) {
        homing = has(INDEX) ? BldcHoming::SEARCHING : BldcHoming::ALIGNING;
        aligned = false;
        init_done = false;
        waited_s = 0.0;
        if (has(INDEX)) {
            index_enable = true;
        }
    }
    last_init = is_init;
    waited_s += dt;
    const double direction = rev != (initvalue < 0.0) ? -1.0 : 1.0;
    if (homing == BldcHoming::SEARCHING) {
        field = bldc::fraction(direction * waited_s);
        if (aligned) {
            homing = BldcHoming::DONE;
            init_done = true;
        }
    } else if (homing == BldcHoming::ALIGNING) {
        const double part = waited_s < ALIGN_TURN_S ? waited_s / ALIGN_TURN_S : 1.0;
        field = bldc::fraction(direction * (part - 1.0) * 0.5);
        if (waited_s >= ALIGN_TURN_S + ALIGN_HOLD_S) {
            const double at = drive_offset / 360.0 * counts_per_turn();
            zero_counts = rawcounts - (std::isfinite(at) ? static_cast<std::int32_t>(at) : 0);
            offset_measured = zero_counts;
            aligned = true;
            homing = BldcHoming::DONE;
            init_done = true;
        }
    }
}

void Bldc::write(double phase, int commuted, double size) noexcept {
    const bool is_trapezoid = commuted >= 0;
    const bldc::Phases phases = is_trapezoid ? bldc::trapezoid(commuted, size) : bldc::sine(phase, size);
    const bldc::Phases switched =
        bldc::trapezoid(is_trapezoid ? commuted : bldc::sector_of_phase(phase), size);
    const unsigned kind = tags & PHASE_OUTPUTS;
    const double values[3] = {phases.a, phases.b, phases.c};
    const double sources[3] = {switched.a, switched.b, switched.c};
    for (int i = 0; i < 3; ++i) {
        if (kind == 0) {
            phase_out[i] = values[i];
        } else if (kind == SIX_OUT) {
            phase_out[i] = std::fmax(values[i], 0.0);
            phase_out[i + 3] = std::fmax(-values[i], 0.0);
        } else if (kind == BITS_OUT || kind == (BITS_OUT | SIX_OUT)) {
            on[i] = sources[i] > 0.0;
            if (has(SIX_OUT)) {
                on[i + 3] = sources[i] < 0.0;
            }
        }
    }
}

void Bldc::write_codes(double phase) noexcept {
    if (has(HALL_OUT)) {
        const std::uint32_t wanted = output_pattern;
        const int number = wanted < bldc::PATTERNS ? static_cast<int>(wanted) : 0;
        const unsigned code = bldc::hall_of_sector(number, bldc::sector_of_phase(phase));
        for (int i = 0; i < 3; ++i) {
            hall_out[i] = (code >> (2 - i) & 1U) != 0;
        }
    }
    if (has(FANUC_OUT)) {
        const std::uint32_t code = logic::gray_of(static_cast<std::uint32_t>(rotor * 16.0));
        for (int i = 0; i < 4; ++i) {
            fanuc_out[i] = (code >> i & 1U) != 0;
        }
    }
}

void Bldc::update(long period_ns) noexcept {
    const double dt = seconds(period_ns);
    const double wanted = value;
    double amplitude = std::isfinite(wanted) ? (rev ? -wanted : wanted) : 0.0;
    if (has(HALL)) {
        read_hall();
    }
    if (has(ABSOLUTE | QUADRATURE)) {
        read_encoder();
    } else if (has(FANUC)) {
        const std::uint32_t code =
            (fanuc[0] ? 1U : 0U) | (fanuc[1] ? 2U : 0U) | (fanuc[2] ? 4U : 0U) | (fanuc[3] ? 8U : 0U);
        rotor = (logic::binary_of_gray(code) + 0.5) / 16.0;
    } else if (!has(HALL) && !has(INDEX)) {
        const double turned = frequency * dt * (amplitude < 0.0 ? -1.0 : 1.0);
        rotor = std::isfinite(turned) ? bldc::fraction(rotor + turned) : rotor;
    }
    if (has(QUADRATURE) && !has(HALL)) {
        run_homing(dt);
    }
    last_index = has(INDEX) && index_enable;
    const bool is_homing = homing == BldcHoming::ALIGNING || homing == BldcHoming::SEARCHING;
    const bool usesHall = has(HALL) && !has(ABSOLUTE) && !aligned;
    const bool lost = !has(ABSOLUTE | HALL) && has(QUADRATURE) && !aligned && !is_homing;
    const bool free = !has(HALL | ABSOLUTE | QUADRATURE | FANUC);
    if (is_homing) {
        amplitude = std::fabs(initvalue);
    } else if (lost || (usesHall && sector < 0)) {
        amplitude = 0.0;
    }
    const double lead = free || is_homing ? 0.0 : (has(ABSOLUTE | QUADRATURE) ? lead_angle / 360.0 : 0.25);
    const double phase = bldc::fraction((is_homing ? field : rotor) + (amplitude < 0.0 ? -lead : lead));
    int commuted = -1;
    if (usesHall && sector >= 0) {
        commuted = amplitude < 0.0 ? (sector + 3) % bldc::SECTORS : sector;
    } else if (has(TRAPEZOID)) {
        commuted = bldc::sector_of_phase(phase);
    }
    const double size = std::fabs(amplitude);
    write(phase, commuted, size);
    write_codes(phase);
    phase_angle = phase;
    rotor_angle = rotor;
    out = amplitude;
    out_dir = amplitude < 0.0;
    out_abs = size;
    in_type = static_cast<std::int32_t>(homing);
    out_type = static_cast<std::int32_t>(tags >> 8);
}

struct Bldcs {
    int load(int comp_id) noexcept {
        int status = 0;
        int count = 0;
        for (; count < MAX_MOTORS && cfg[count] != nullptr && cfg[count][0] != '\0' && status == 0; ++count) {
            Bldc *made = make<Bldc>();
            if (made == nullptr) {
                return -ENOMEM;
            }
            if (!parse(cfg[count], made->tags)) {
                rtapi_print_msg(RTAPI_MSG_ERR,
                                "bldc: cfg has '%s', possible letters are n h a q i f B 6 H F T", cfg[count]);
                return -EINVAL;
            }
            Name prefix;
            rtapi_snprintf(prefix.text, sizeof prefix.text, "bldc.%d", count);
            Declare d(comp_id, prefix.text, count);
            made->declare(d);
            status = d.status();
        }
        if (count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "bldc: cfg= is missing, for example cfg=qi6");
            status = -EINVAL;
        }
        return status;
    }

  private:
    static bool parse(const char *text, unsigned &tags) noexcept {
        for (; *text != '\0'; ++text) {
            switch (*text) {
            case 'n': break;
            case 'h': tags |= HALL; break;
            case 'a': tags |= ABSOLUTE; break;
            case 'q': tags |= QUADRATURE; break;
            case 'i': tags |= INDEX; break;
            case 'f': tags |= FANUC; break;
            case 'B': tags |= BITS_OUT; break;
            case '6': tags |= SIX_OUT; break;
            case 'H': tags |= HALL_OUT; break;
            case 'F': tags |= FANUC_OUT; break;
            case 'T': tags |= TRAPEZOID; break;
            default: return false;
            }
        }
        return true;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Bldcs, "bldc");
