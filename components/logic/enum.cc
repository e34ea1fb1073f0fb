// SPDX-License-Identifier: GPL-2.0-or-later
// enum: names for numbers. `enums="E;off;fwd;rev,D;slow;;fast"` makes an encoder of three bits and a decoder
// of two; `names=` names the instances.
//
// The items after E or D get the numbers 0, 1, 2, ...; an empty one is left out. Encoder: `output` (u32) is
// the number of the first NAME-in (bit) that is true, 0 when none is. Decoder: each NAME-out (bit) is true
// while `input` (u32) is its number. The parameter NAME-val (u32) is the number of an item and may be set.
#include "hal/sdk/component.hh"

static char *enums[mw::sdk::MANY];
RTAPI_MP_ARRAY_STRING(enums, mw::sdk::MANY, "E or D and the names of each instance");
static char *names[mw::sdk::MANY];
RTAPI_MP_ARRAY_STRING(names, mw::sdk::MANY, "names of the instances");

namespace mw::components {
using namespace sdk;

constexpr int MAX_ITEMS = 32;
constexpr int MAX_LABEL = 40;

struct EnumItem {
    In<bool> in;
    Out<bool> out;
    ParamRw<std::uint32_t> value;
};

struct Enum {
    const char *text = "";
    bool is_encoder = false;
    int items = 0;
    EnumItem item[MAX_ITEMS];
    In<std::uint32_t> input;
    Out<std::uint32_t> output;

    void declare(Declare &d) noexcept {
        is_encoder = (text[0] | 0x20) == 'e';
        const bool is_decoder = (text[0] | 0x20) == 'd';
        const char *rest = text[0] == '\0' ? text : text + 1;
        bool good = (is_encoder || is_decoder) && *rest == ';';
        for (std::uint32_t number = 0; good && *rest == ';'; ++number) {
            ++rest;
            int length = 0;
            while (rest[length] != '\0' && rest[length] != ';') {
                ++length;
            }
            good = length == 0 || declare_item(d, rest, length, number);
            rest += length;
        }
        if (!good || items == 0) {
            rtapi_print_msg(
                RTAPI_MSG_ERR,
                "enum: '%s' is not E or D and up to %d names of at most %d characters, as in E;off;on", text,
                MAX_ITEMS, MAX_LABEL);
            d.keep(-EINVAL);
            return;
        }
        if (is_encoder) {
            d.pin(output, "output");
        } else {
            d.pin(input, "input");
        }
        d.function<&Enum::update>(this);
    }

    void update() noexcept {
        if (!is_encoder) {
            const std::uint32_t number = input;
            for (int i = 0; i < items; ++i) {
                item[i].out = item[i].value == number;
            }
            return;
        }
        std::uint32_t number = 0;
        for (int i = items - 1; i >= 0; --i) {
            number = item[i].in ? item[i].value.get() : number;
        }
        output = number;
    }

  private:
    bool declare_item(Declare &d, const char *label, int length, std::uint32_t number) noexcept {
        if (items >= MAX_ITEMS || length > MAX_LABEL) {
            return false;
        }
        char name[MAX_LABEL + 8];
        rtapi_snprintf(name, sizeof name, "%.*s-val", length, label);
        d.param(item[items].value, name, number);
        rtapi_snprintf(name, sizeof name, "%.*s-%s", length, label, is_encoder ? "in" : "out");
        if (is_encoder) {
            d.pin(item[items].in, name);
        } else {
            d.pin(item[items].out, name);
        }
        ++items;
        return true;
    }
};

struct Enums {
    int load(int comp_id) noexcept {
        int status = 0;
        int count = 0;
        for (; count < MANY && enums[count] != nullptr && status == 0; ++count) {
            Enum *made = make<Enum>();
            if (made == nullptr) {
                return -ENOMEM;
            }
            made->text = enums[count];
            Name prefix;
            const bool named = names[count] != nullptr && names[count][0] != '\0';
            if (named) {
                rtapi_snprintf(prefix.text, sizeof prefix.text, "%s", names[count]);
            } else {
                rtapi_snprintf(prefix.text, sizeof prefix.text, "enum.%d", count);
            }
            Declare d(comp_id, prefix.text, count);
            made->declare(d);
            status = d.status();
        }
        if (count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "enum: enums= is missing, for example enums=E;off;on");
            status = -EINVAL;
        }
        return status;
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Enums, "enum");
