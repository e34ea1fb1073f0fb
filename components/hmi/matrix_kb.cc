// SPDX-License-Identifier: GPL-2.0-or-later
// matrix_kb: keys of a matrix keyboard, from its key codes or by scanning rows and columns. `config=4x8,2x3s`
// makes keyboards of 4 rows and 8 columns, and of 2 rows and 3 columns that are scanned (`s`); `names=` names
// them.
//
// `key.rRcC` (bit) is true while the key is pressed. Without s `keycode` (u32) is an input: 0xC0 plus the
// number of the key when it is pressed, 0x80 plus it when it is released, others change nothing; the number
// is the row times the power of two not below the columns, plus the column. With s keycode is an output with
// such codes (0x40 in between); in each run one of `row-RR-out` (bit) is active and `col-CC-in` (bit) of the
// row before are read; a key counts when it is the same in two scans. Parameters: `key-rollover` (u32, 2; old
// name key_rollover), how many keys may be pressed at once; with s `negative-logic` (bit, true): active is
// false.
#include "hal/sdk/component.hh"

constexpr int MAX_KEYBOARDS = 16;
static char *config[MAX_KEYBOARDS];
RTAPI_MP_ARRAY_STRING(config, MAX_KEYBOARDS, "rows x columns of each keyboard, with s to scan it");
static char *names[MAX_KEYBOARDS];
RTAPI_MP_ARRAY_STRING(names, MAX_KEYBOARDS, "names of the keyboards");

namespace mw::components {
using namespace sdk;

constexpr int MAX_LINES = 32;
constexpr std::uint32_t KEY_DOWN = 0xc0;
constexpr std::uint32_t KEY_UP = 0x80;
constexpr std::uint32_t NO_KEY = 0x40;
constexpr std::uint32_t KEY_NUMBER = 0x3f;

struct MatrixKb {
    int rows = 0;
    int columns = 0;
    int column_bits = 0;
    bool scanned = false;
    In<bool> column_in[MAX_LINES];
    Out<bool> row_out[MAX_LINES];
    Out<bool> *key = nullptr;  ///< rows * columns
    bool *lastScan = nullptr;
    In<std::uint32_t> code_in;
    Out<std::uint32_t> code_out;
    ParamRw<std::uint32_t> rollover;
    ParamRw<bool> negative_logic;
    int row = 0;
    std::uint32_t held = 0;

    bool parse(const char *text) noexcept;
    void declare(Declare &d) noexcept;
    void update() noexcept;

  private:
    bool change(Out<bool> &changed, bool down) noexcept;
    void take(std::uint32_t code) noexcept;
    void scan() noexcept;
};

bool MatrixKb::parse(const char *text) noexcept {
    int *number = &rows;
    for (; *text != '\0' && !scanned; ++text) {
        if (*text >= '0' && *text <= '9') {
            *number = 10 * *number + (*text - '0');
            if (*number > MAX_LINES) {
                return false;
            }
        } else if ((*text == 'x' || *text == 'X') && number == &rows) {
            number = &columns;
        } else if (*text == 's' || *text == 'S') {
            scanned = true;
        } else {
            return false;
        }
    }
    while (1 << column_bits < columns) {
        ++column_bits;
    }
    return *text == '\0' && rows > 0 && columns > 0;
}

void MatrixKb::declare(Declare &d) noexcept {
    const long keys = static_cast<long>(rows) * columns;
    key = static_cast<Out<bool> *>(hal_malloc(keys * static_cast<long>(sizeof(Out<bool>))));
    lastScan = static_cast<bool *>(hal_malloc(keys));
    if (key == nullptr || lastScan == nullptr) {
        d.keep(-ENOMEM);
        return;
    }
    for (int i = 0; i < keys; ++i) {
        char name[24];
        rtapi_snprintf(name, sizeof name, "key.r%Xc%X", static_cast<unsigned>(i / columns),
                       static_cast<unsigned>(i % columns));
        new (&key[i]) Out<bool>();
        lastScan[i] = false;
        d.pin(key[i], name);
    }
    d.legacy_param(rollover, "key-rollover", "key_rollover", 2U);
    if (scanned) {
        for (int i = 0; i < rows; ++i) {
            d.pin_at(row_out[i], "row-%02d-out", i);
        }
        for (int i = 0; i < columns; ++i) {
            d.pin_at(column_in[i], "col-%02d-in", i);
        }
        d.pin(code_out, "keycode");
        d.param(negative_logic, "negative-logic", true);
    } else {
        d.pin(code_in, "keycode");
    }
    d.function<&MatrixKb::update>(this);
}

/// Sets a key. False when nothing changes, or when the press is above the rollover.
bool MatrixKb::change(Out<bool> &changed, bool down) noexcept {
    if (down == changed.get() || (down && held >= rollover)) {
        return false;
    }
    changed = down;
    held = down ? held + 1 : held - 1;
    return true;
}

/// Sets the key for a code; a press above the rollover is ignored.
void MatrixKb::take(std::uint32_t code) noexcept {
    const std::uint32_t kind = code & ~KEY_NUMBER;
    const std::uint32_t number = code & KEY_NUMBER;
    const int at_row = static_cast<int>(number >> column_bits);
    const int at_column = static_cast<int>(number & ((1U << column_bits) - 1U));
    if ((kind != KEY_DOWN && kind != KEY_UP) || at_row >= rows || at_column >= columns) {
        return;
    }
    change(key[at_row * columns + at_column], kind == KEY_DOWN);
}

void MatrixKb::scan() noexcept {
    const bool active = !negative_logic;
    std::uint32_t code = NO_KEY;
    for (int column = 0; column < columns; ++column) {
        const int i = row * columns + column;
        const bool down = column_in[column] == active;
        const bool steady = down == lastScan[i];
        lastScan[i] = down;
        if (steady && change(key[i], down)) {
            const std::uint32_t number =
                (static_cast<std::uint32_t>(row) << column_bits) + static_cast<std::uint32_t>(column);
            code = (down ? KEY_DOWN : KEY_UP) + number;
        }
    }
    code_out = code;
    row = row + 1 < rows ? row + 1 : 0;
    for (int i = 0; i < rows; ++i) {
        row_out[i] = (i == row) == active;
    }
}

void MatrixKb::update() noexcept {
    if (scanned) {
        scan();
    } else {
        take(code_in);
    }
}

struct MatrixKbs {
    int load(int comp_id) noexcept {
        int status = 0;
        int count = 0;
        for (; count < MAX_KEYBOARDS && config[count] != nullptr && status == 0; ++count) {
            MatrixKb *made = make<MatrixKb>();
            if (made == nullptr) {
                return -ENOMEM;
            }
            if (!made->parse(config[count])) {
                rtapi_print_msg(
                    RTAPI_MSG_ERR,
                    "matrix_kb: config has '%s', expected ROWSxCOLUMNS (to %d each), with s to scan",
                    config[count], MAX_LINES);
                return -EINVAL;
            }
            Name prefix;
            const bool named = names[count] != nullptr && names[count][0] != '\0';
            if (named) {
                rtapi_snprintf(prefix.text, sizeof prefix.text, "%s", names[count]);
            } else {
                rtapi_snprintf(prefix.text, sizeof prefix.text, "matrix_kb.%d", count);
            }
            Declare d(comp_id, prefix.text, count);
            made->declare(d);
            status = d.status();
        }
        if (count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "matrix_kb: config= is missing, for example config=4x4s");
            status = -EINVAL;
        }
        return status;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::MatrixKbs, "matrix_kb");
