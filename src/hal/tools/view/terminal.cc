// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/view/terminal.hh"

#include <curses.h>
#include <unistd.h>

#include <clocale>
#include <cstdio>
#include <string>

namespace mw::hal::view {

namespace {

constexpr int REFRESH_MS = 100;

/// The screen, restored at the end.
class Screen {
  public:
    Screen() {
        std::setlocale(LC_CTYPE, "");
        screen_ = newterm(nullptr, stdout, stdin);
        if (screen_ != nullptr) {
            cbreak();
            noecho();
            keypad(stdscr, true);
            curs_set(0);
            set_escdelay(25);
            timeout(REFRESH_MS);
        }
    }
    ~Screen() {
        if (screen_ != nullptr) {
            endwin();
            delscreen(screen_);
        }
    }
    Screen(const Screen &) = delete;
    Screen &operator=(const Screen &) = delete;
    bool isOpen() const { return screen_ != nullptr; }

  private:
    SCREEN *screen_;
};

Key key_of(int code) {
    switch (code) {
    case KEY_UP: return Key::UP;
    case KEY_DOWN: return Key::DOWN;
    case KEY_PPAGE: return Key::PAGE_UP;
    case KEY_NPAGE: return Key::PAGE_DOWN;
    case KEY_HOME: return Key::HOME;
    case KEY_END: return Key::END;
    case KEY_RIGHT: return Key::OPEN;
    case KEY_LEFT: return Key::CLOSE;
    case ' ': return Key::TOGGLE;
    case '\t': return Key::NEXT_PAGE;
    case 'w': return Key::WATCH;
    case '/': return Key::FILTER;
    case 's': return Key::SET;
    case '\r':
    case '\n':
    case KEY_ENTER: return Key::ENTER;
    case 27: return Key::ESCAPE;
    case KEY_BACKSPACE:
    case 127:
    case 8: return Key::ERASE;
    case 'q': return Key::QUIT;
    default: return Key::NONE;
    }
}

bool isText(int code) {
    return code >= ' ' && code < 127;
}

void take_key(WatchModel &model, int code) {
    if (code == ERR) {
        return;
    }
    if (model.isTyping() && isText(code)) {
        model.type(std::string(1, static_cast<char>(code)));
    } else {
        model.press(key_of(code));
    }
}

void put_line(int y, const std::string &text, int width, attr_t look) {
    attrset(look);
    mvaddnstr(y, 0, text.c_str(), width);
    clrtoeol();
    attrset(A_NORMAL);
}

void draw(const WatchModel &model, int height, int width) {
    static constexpr const char *PAGES[] = {"pins", "signals", "threads", "watched"};
    std::string head = "millwright hal ";
    for (int i = 0; i < 4; ++i) {
        head += i == static_cast<int>(model.page()) ? std::string("[") + PAGES[i] + "] "
                                                    : std::string(PAGES[i]) + " ";
    }
    put_line(0, head, width, A_BOLD);
    for (int y = 1; y < height - 1; ++y) {
        const std::size_t i = model.top() + static_cast<std::size_t>(y - 1);
        const bool present = i < model.rows().size();
        put_line(y, present ? row_text(model.rows()[i], static_cast<std::size_t>(width)) : "", width,
                 present && i == model.cursor() ? A_REVERSE : A_NORMAL);
    }
    put_line(height - 1, model.status(), width - 1, A_BOLD);
    refresh();
}

}  // namespace

Result<> run_terminal(WatchModel &model, volatile std::sig_atomic_t &stop) {
    if (::isatty(STDOUT_FILENO) == 0 || ::isatty(STDIN_FILENO) == 0) {
        return fail("this needs a terminal", {}, "millwright hal watch NAME... prints lines instead");
    }
    const Screen screen;
    if (!screen.isOpen()) {
        return fail("unknown terminal type", {}, "set TERM");
    }
    while (!model.isDone() && stop == 0) {
        int height = 0, width = 0;
        getmaxyx(stdscr, height, width);
        model.set_height(static_cast<std::size_t>(height > 2 ? height - 2 : 1));
        model.refresh();
        draw(model, height, width);
        take_key(model, getch());
    }
    return {};
}

}  // namespace mw::hal::view
