// SPDX-License-Identifier: GPL-2.0-or-later
// lcd: streams values to a character display, one character a period. The manual page describes all pins.
#include "components/hmi/lcd_core.hh"
#include "hal/sdk/component.hh"

constexpr int MAX_DISPLAYS = 8;
static char *fmt_strings[MAX_DISPLAYS];
RTAPI_MP_ARRAY_STRING(fmt_strings, MAX_DISPLAYS, "pages of each display");

namespace mw::components {
using namespace sdk;

constexpr int MAX_PAGES = 32;
constexpr int MAX_ITEMS = 1024;
constexpr int START_PERIODS = 100;
// Codes of an ADM-3 terminal.
constexpr char START_CODES[] = "\r\n\x18\r\n\x18\r\n\x18\r\n\x18\x11\x11";
constexpr char NEW_PAGE_CODES[] = "\x1e\x1a";
constexpr char TO_TOP_CODES[] = "\x1b=  ";
constexpr char LINE_CODES[] = "\x18\r\n";
constexpr char TAB_CODES[] = "    ";

struct LcdItem {
    lcd::Item format;
    hal_data_u *value = nullptr;  ///< for a number
};

struct Lcd {
    LcdItem items[MAX_ITEMS];
    int first_item[MAX_PAGES + 1] = {};
    int pages = 0;
    Out<std::uint32_t> out;
    In<std::uint32_t> page_num;
    In<double> contrast;
    ParamRw<std::uint32_t> separator;

    lcd::Text pending;  // characters that are sent before the next item
    int sent = 0;
    int item = 0;
    int page = -1;
    int started = 0;
    double last_contrast = 0.0;

    bool parse(Declare &d, const char *text) noexcept;
    void declare(Declare &d) noexcept;
    void update() noexcept;

  private:
    bool add_item(Declare &d, const char *&text, int &args) noexcept;
    void send(const char *codes) noexcept;
    void refill() noexcept;
    void send_item(const LcdItem &shown) noexcept;
};

/// Adds one item of a format; a number gets a pin of its type.
bool Lcd::add_item(Declare &d, const char *&text, int &args) noexcept {
    if (first_item[pages] >= MAX_ITEMS - 4) {
        return false;
    }
    const bool is_code = text[0] == '\\' && (text[1] == 'n' || text[1] == 't');
    if (is_code) {
        for (const char *code = text[1] == 'n' ? LINE_CODES : TAB_CODES; *code != '\0'; ++code) {
            items[first_item[pages]++].format.character = static_cast<std::uint8_t>(*code);
        }
        text += 2;
        return true;
    }
    LcdItem &made = items[first_item[pages]++];
    if (!lcd::parse_item(text, made.format)) {
        return false;
    }
    using Kind = lcd::Item::Kind;
    if (made.format.kind == Kind::CHARACTER) {
        return true;
    }
    const hal_type_t type = made.format.kind == Kind::FLOAT    ? HAL_FLOAT
                            : made.format.kind == Kind::SIGNED ? HAL_S32
                            : made.format.kind == Kind::BIT    ? HAL_BIT
                                                               : HAL_U32;
    Name name;
    rtapi_snprintf(name.text, sizeof name.text, "%s.page.%02d.arg.%02d", d.prefix(), pages - 1, args++);
    return d.keep(hal_pin_new(name.text, type, HAL_IN, reinterpret_cast<void **>(&made.value), d.comp_id()));
}

/// first_item[p] is the first item of page p; first_item[pages] is the end of the last page.
bool Lcd::parse(Declare &d, const char *text) noexcept {
    int args = 0;
    pages = 1;
    while (*text != '\0') {
        if (*text == '|') {
            if (pages >= MAX_PAGES) {
                return false;
            }
            ++text;
            args = 0;
            first_item[pages + 1] = first_item[pages];
            ++pages;
        } else if (!add_item(d, text, args)) {
            return false;
        }
    }
    return true;
}

void Lcd::declare(Declare &d) noexcept {
    const char *text = fmt_strings[d.index()];
    if (!parse(d, text) || d.status() < 0) {
        rtapi_print_msg(RTAPI_MSG_ERR, "lcd: the format '%s' has a mistake or is too long", text);
        d.keep(-EINVAL);
        return;
    }
    d.pin(out, "out");
    d.legacy_pin(page_num, "page-num", "page_num");
    d.pin(contrast, "contrast");
    d.param(separator, "decimal-separator", static_cast<std::uint32_t>('.'));
}

void Lcd::send(const char *codes) noexcept {
    for (; *codes != '\0'; ++codes) {
        pending.add(*codes);
    }
}

void Lcd::send_item(const LcdItem &shown) noexcept {
    using Kind = lcd::Item::Kind;
    const lcd::Item &format = shown.format;
    switch (format.kind) {
    case Kind::CHARACTER: pending.add(static_cast<char>(format.character)); break;
    case Kind::FLOAT:
        pending = lcd::show_float(format, shown.value->f, static_cast<char>(separator.get()));
        break;
    case Kind::SIGNED: {
        const std::int32_t value = shown.value->s;
        const auto bits = static_cast<std::uint32_t>(value);
        pending = lcd::show_integer(format, value < 0 ? 0U - bits : bits, value < 0);
        break;
    }
    case Kind::CHAR_CODE: pending = lcd::show_character(format, shown.value->u); break;
    case Kind::BIT: pending = lcd::show_character(format, shown.value->b ? 1U : 0U); break;
    default: pending = lcd::show_integer(format, shown.value->u, false); break;
    }
}

/// The next characters to send; none for one period at the end of a page.
void Lcd::refill() noexcept {
    pending = lcd::Text{};
    sent = 0;
    const std::uint32_t wanted = page_num;
    const int chosen = wanted < static_cast<std::uint32_t>(pages) ? static_cast<int>(wanted) : pages - 1;
    const double level = contrast;
    if (chosen != page) {
        page = chosen;
        item = first_item[page];
        send(NEW_PAGE_CODES);
    } else if (level != last_contrast && level >= 0.0 && level <= 1.0) {
        constexpr double LOWEST = 0x20;
        constexpr double HIGHEST = 0xbf;
        last_contrast = level;
        send("\x1b"
             "C");
        pending.add(static_cast<char>(static_cast<int>(LOWEST + level * (HIGHEST - LOWEST))));
    } else if (item < first_item[page + 1]) {
        send_item(items[item++]);
    } else {
        item = first_item[page];
        send(TO_TOP_CODES);
    }
}

void Lcd::update() noexcept {
    if (started < START_PERIODS) {
        out = 0U;
        if (++started == START_PERIODS) {
            send(START_CODES);
        }
        return;
    }
    if (sent >= pending.length) {
        refill();
    }
    out = sent < pending.length ? static_cast<unsigned char>(pending.text[sent]) : 0U;
    ++sent;
}

struct Lcds {
    int count = 0;
    Lcd *display[MAX_DISPLAYS] = {};

    int load(int comp_id) noexcept {
        for (; count < MAX_DISPLAYS && fmt_strings[count] != nullptr; ++count) {
            display[count] = make<Lcd>();
            if (display[count] == nullptr) {
                return -ENOMEM;
            }
            Name prefix;
            rtapi_snprintf(prefix.text, sizeof prefix.text, "lcd.%02d", count);
            Declare d(comp_id, prefix.text, count);
            display[count]->declare(d);
            if (d.status() < 0) {
                return d.status();
            }
        }
        if (count == 0) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "lcd: fmt_strings= is missing, for example fmt_strings=\"X %%8.3f\"");
            return -EINVAL;
        }
        Declare d(comp_id, "lcd", 0);
        d.function<&Lcds::update>(this);
        return d.status();
    }

    void update() noexcept {
        for (int i = 0; i < count; ++i) {
            display[i]->update();
        }
    }
};

}  // namespace mw::components

MW_COMPONENT_SINGLE(mw::components::Lcds, "lcd");
