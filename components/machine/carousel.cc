// SPDX-License-Identifier: GPL-2.0-or-later
// carousel: turns a tool carousel to a pocket, with many types of sensors. The manual page describes all
// pins.
#include <cmath>

#include "components/machine/carousel_core.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_CAROUSELS = 8;
constexpr int NOT_GIVEN = -1;
#define MW_EIGHT(value) {value, value, value, value, value, value, value, value}
static int pockets[MAX_CAROUSELS];
RTAPI_MP_ARRAY_INT(pockets, MAX_CAROUSELS, "pockets of each carousel");
static char *encoding[MAX_CAROUSELS];
RTAPI_MP_ARRAY_STRING(encoding, MAX_CAROUSELS, "gray, binary, bcd, index, edge, counts or single");
static int num_sense[MAX_CAROUSELS] = MW_EIGHT(NOT_GIVEN);
RTAPI_MP_ARRAY_INT(num_sense, MAX_CAROUSELS, "position inputs of each carousel");
static int dir[MAX_CAROUSELS] = MW_EIGHT(NOT_GIVEN);
RTAPI_MP_ARRAY_INT(dir, MAX_CAROUSELS, "1 forwards only, 2 both directions");
static int parity[MAX_CAROUSELS] = MW_EIGHT(NOT_GIVEN);
RTAPI_MP_ARRAY_INT(parity, MAX_CAROUSELS, "1 odd, 0 even parity");

namespace mw::components {
using namespace sdk;

constexpr int MAX_SENSE = 32;
constexpr int MAX_POCKETS = 1000;

enum CarouselState : std::int32_t { IDLE, HOMING, MOVING, LOCKING, SLOWING, BACK_ON, BACK_OFF, FORWARD_ON };

struct Carousel {
    carousel::Position position;
    bool bidirectional = true;
    bool odd_parity = false;

    In<std::int32_t> pocket_number;
    In<bool> enable, strobe, parity_in, sense[MAX_SENSE];
    In<double> rev_pulse, fwd_dc, rev_dc, hold_dc, align_dc, decel_time;
    In<std::int32_t> counts, scale, width, home_offset;
    InOut<bool> index_enable;
    In<bool> jog_fwd, jog_rev, unhome;
    Out<bool> active, ready, motor_fwd, motor_rev, parity_error, homed;
    Out<std::int32_t> current_position;
    Out<double> motor_vel;
    ParamRo<std::int32_t> state, motor_dir;
    ParamRo<bool> homing;
    ParamRo<double> timer;
    ParamRo<std::uint32_t> debounce;

    std::int32_t target = 0;
    int search_direction = 0;
    bool isJogging = false;
    bool last_enable = false;
    bool last_jog_fwd = false;
    bool last_jog_rev = false;

    void declare(Declare &d) noexcept;
    void declare_outputs(Declare &d) noexcept;
    void update(long period_ns) noexcept;

  private:
    carousel::Sensors sensors() noexcept;
    void start() noexcept;
    void start_jog(int direction) noexcept;
    void begin_move() noexcept;
    void arrive() noexcept;
    void finish_move() noexcept;
    void run_state(const carousel::Sensors &now, double dt) noexcept;
    void run_homing(const carousel::Sensors &now) noexcept;
    void run_alignment(const carousel::Sensors &now) noexcept;
    void drive(int direction, double velocity) noexcept {
        motor_fwd = direction > 0;
        motor_rev = direction < 0;
        motor_vel = std::isfinite(velocity) ? velocity : 0.0;
        motor_dir = direction;
    }
};

void Carousel::declare(Declare &d) noexcept {
    d.pin(pocket_number, "pocket-number");
    d.pin(enable, "enable");
    d.pin(strobe, "strobe", true);
    d.pin(parity_in, "parity");
    for (int i = 0; i < position.sense_pins; ++i) {
        d.pin_at(sense[i], "sense-%d", i);
    }
    d.pin(rev_pulse, "rev-pulse");
    d.pin(fwd_dc, "fwd-dc");
    d.pin(rev_dc, "rev-dc");
    d.pin(hold_dc, "hold-dc");
    d.pin(align_dc, "align-dc");
    d.pin(decel_time, "decel-time");
    d.pin(counts, "counts");
    d.pin(scale, "scale", 100);
    d.pin(width, "width");
    d.pin(home_offset, "home-offset");
    d.pin(index_enable, "index-enable");
    d.pin(jog_fwd, "jog-fwd");
    d.pin(jog_rev, "jog-rev");
    d.pin(unhome, "unhome");
    declare_outputs(d);
    d.function<&Carousel::update>(this);
}

void Carousel::declare_outputs(Declare &d) noexcept {
    d.pin(active, "active");
    d.pin(ready, "ready");
    d.pin(motor_fwd, "motor-fwd");
    d.pin(motor_rev, "motor-rev");
    d.pin(parity_error, "parity-error");
    d.pin(current_position, "current-position");
    d.pin(motor_vel, "motor-vel");
    d.pin(homed, "homed");
    d.param(state, "state");
    d.param(homing, "homing");
    d.param(timer, "timer");
    d.param(motor_dir, "motor-dir");
    d.param(debounce, "debounce");
}

carousel::Sensors Carousel::sensors() noexcept {
    carousel::Sensors now;
    int trues = parity_in ? 1 : 0;
    for (int i = 0; i < position.sense_pins; ++i) {
        const bool high = sense[i];
        now.bits |= high ? 1U << i : 0U;
        trues += high ? 1 : 0;
    }
    now.valid = strobe;
    if (now.valid && !position.needsHoming()) {
        parity_error = (trues % 2 != 0) != odd_parity;
    }
    now.counts = counts;
    now.scale = scale;
    now.width = width;
    now.home_offset = home_offset;
    return now;
}

void Carousel::start() noexcept {
    isJogging = false;
    if (pocket_number < 1) {
        return;
    }
    ready = false;
    target = carousel::folded(pocket_number, position.pockets);
    active = true;
    if (position.needsHoming() && !position.isHomed) {
        state = HOMING;
        index_enable = position.encoding == carousel::Encoding::COUNTS;
    } else {
        begin_move();
    }
}

void Carousel::start_jog(int direction) noexcept {
    const bool possible = direction > 0 || bidirectional;
    if (!possible || position.pocket < 1) {
        return;
    }
    isJogging = true;
    ready = false;
    active = true;
    target = (position.pocket - 1 + direction + position.pockets) % position.pockets + 1;
    search_direction = direction;
    state = MOVING;
}

void Carousel::begin_move() noexcept {
    search_direction = carousel::shortest_way(position.pocket, target, position.pockets, bidirectional);
    if (search_direction == 0) {
        finish_move();
        return;
    }
    state = MOVING;
}

/// The requested pocket has reached its position.
void Carousel::arrive() noexcept {
    timer = 0.0;
    if (align_dc != 0.0) {
        state = SLOWING;
    } else if (rev_pulse > 0.0) {
        state = LOCKING;
    } else {
        finish_move();
    }
}

void Carousel::finish_move() noexcept {
    state = IDLE;
    active = false;
    ready = !isJogging;
}

/// Homing continues after enable becomes false, so a pulse is enough to start it.
void Carousel::run_homing(const carousel::Sensors &now) noexcept {
    if (!position.findHome(now)) {
        return;
    }
    if (enable) {
        begin_move();
    } else {
        state = IDLE;
        active = false;
    }
}

void Carousel::run_alignment(const carousel::Sensors &now) noexcept {
    const bool on = position.isOnMarker(now, target);
    if (state == BACK_ON && on) {
        state = BACK_OFF;
    } else if (state == BACK_OFF && !on) {
        state = FORWARD_ON;
    } else if (state == FORWARD_ON && on) {
        timer = 0.0;
        state = rev_pulse > 0.0 ? LOCKING : IDLE;
        if (state == IDLE) {
            finish_move();
        }
    }
}

void Carousel::run_state(const carousel::Sensors &now, double dt) noexcept {
    switch (state) {
    case HOMING: run_homing(now); break;
    case MOVING:
        if (position.pocket == target) {
            arrive();
        }
        break;
    case LOCKING:
        timer = timer + dt;
        if (!(timer < rev_pulse)) {
            finish_move();
        }
        break;
    case SLOWING:
        timer = timer + dt;
        if (!(timer < decel_time)) {
            state = search_direction > 0 ? BACK_ON : BACK_OFF;
        }
        break;
    case BACK_ON:
    case BACK_OFF:
    case FORWARD_ON: run_alignment(now); break;
    default: break;
    }
}

void Carousel::update(long period_ns) noexcept {
    const carousel::Sensors now = sensors();
    const bool aligning = state >= SLOWING;
    if (!aligning || !position.needsHoming()) {
        position.read(now, motor_dir);
    }
    if (unhome) {
        position.isHomed = false;
    }
    const bool enabled = enable;
    const bool started = enabled && !last_enable;
    last_enable = enabled;
    if (state == IDLE && started) {
        start();
    } else if (state == IDLE && !enabled && jog_fwd && !last_jog_fwd) {
        start_jog(1);
    } else if (state == IDLE && !enabled && jog_rev && !last_jog_rev) {
        start_jog(-1);
    } else if (state != IDLE && state != HOMING && !enabled && !isJogging) {
        state = IDLE;
        active = false;
    } else {
        run_state(now, seconds(period_ns));
    }
    last_jog_fwd = jog_fwd;
    last_jog_rev = jog_rev;
    const double slow = std::fabs(align_dc);
    switch (state) {
    case HOMING: drive(1, fwd_dc); break;
    case MOVING: drive(search_direction, search_direction > 0 ? fwd_dc : rev_dc); break;
    case LOCKING: drive(-1, rev_dc); break;
    case SLOWING: drive(0, 0.0); break;
    case BACK_ON:
    case BACK_OFF: drive(-1, -slow); break;
    case FORWARD_ON: drive(1, slow); break;
    default: drive(0, hold_dc); break;
    }
    homing = state == HOMING;
    homed = position.isHomed;
    current_position = position.pocket;
}

struct Carousels {
    /// One pin each for the pockets, index and pulse, or `num_sense` pins.
    static int sense_pins_of(carousel::Encoding kind, int pockets_of_one, int inputs) noexcept {
        switch (kind) {
        case carousel::Encoding::SINGLE: return pockets_of_one;
        case carousel::Encoding::INDEX: return 2;
        case carousel::Encoding::EDGE:
        case carousel::Encoding::COUNTS: return inputs > 2 ? inputs : 2;
        default: return inputs;
        }
    }

    int load(int comp_id) noexcept {
        int status = 0;
        carousel::Encoding kind = carousel::Encoding::GRAY;
        int inputs = 4;
        int directions = 2;
        int odd = 0;
        int count = 0;
        for (; count < MAX_CAROUSELS && pockets[count] != 0 && status == 0; ++count) {
            if (encoding[count] != nullptr && !carousel::parse_encoding(encoding[count], kind)) {
                rtapi_print_msg(RTAPI_MSG_ERR,
                                "carousel: encoding '%s' is none of gray, binary, bcd, index, edge, counts, "
                                "single",
                                encoding[count]);
                return -EINVAL;
            }
            inputs = num_sense[count] != NOT_GIVEN ? num_sense[count] : inputs;
            directions = dir[count] != NOT_GIVEN ? dir[count] : directions;
            odd = parity[count] != NOT_GIVEN ? parity[count] : odd;
            const bool has_too_many = kind == carousel::Encoding::SINGLE && pockets[count] > MAX_SENSE;
            if (has_too_many) {
                rtapi_print_msg(RTAPI_MSG_ERR, "carousel: encoding 'single' has at most %d pockets, not %d",
                                MAX_SENSE, pockets[count]);
                return -EINVAL;
            }
            const bool possible = pockets[count] > 0 && pockets[count] <= MAX_POCKETS && inputs > 0 &&
                                  inputs <= MAX_SENSE && (directions == 1 || directions == 2);
            if (!possible) {
                rtapi_print_msg(RTAPI_MSG_ERR,
                                "carousel: needs 1 to %d pockets, num_sense of 1 to %d and dir of 1 or 2",
                                MAX_POCKETS, MAX_SENSE);
                return -EINVAL;
            }
            Carousel *made = make<Carousel>();
            if (made == nullptr) {
                return -ENOMEM;
            }
            made->position.encoding = kind;
            made->position.pockets = pockets[count];
            made->position.sense_pins = sense_pins_of(kind, pockets[count], inputs);
            made->bidirectional = directions == 2;
            made->odd_parity = odd != 0;
            Name prefix;
            rtapi_snprintf(prefix.text, sizeof prefix.text, "carousel.%d", count);
            Declare d(comp_id, prefix.text, count);
            made->declare(d);
            status = d.status();
        }
        if (count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "carousel: pockets= is missing, for example pockets=12");
            status = -EINVAL;
        }
        return status;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Carousels, "carousel");
