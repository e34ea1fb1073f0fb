// SPDX-License-Identifier: GPL-2.0-or-later
// Content of `millwright hal` and the effect of keys, without a terminal. [one thread]
#pragma once

#include <set>
#include <string>
#include <vector>

#include "base/result.hh"
#include "hal/core/instance.hh"

namespace mw::hal::view {

enum class Page { PINS, SIGNALS, THREADS, WATCH };

enum class Key {
    UP,
    DOWN,
    PAGE_UP,
    PAGE_DOWN,
    HOME,
    END,
    OPEN,
    CLOSE,
    TOGGLE,
    NEXT_PAGE,
    WATCH,
    FILTER,
    SET,
    ENTER,
    ESCAPE,
    ERASE,
    QUIT,
    NONE
};

struct WatchRow {
    int depth = 0;
    std::string label;  ///< last part of the name on the pin page, otherwise the name
    std::string name;   ///< name of the object; for a branch the common prefix of the names below
    bool is_branch = false;
    bool isOpen = false;
    std::string type;  ///< "float IN", "s32 RW", "bit"
    std::string value;
    std::string extra;  ///< link of a pin, pins of a signal, times of a function
};

class WatchModel {
  public:
    explicit WatchModel(Instance &hal) : hal_(&hal) {}

    /// Reads all values again.
    void refresh();
    /// Handles a key; type() handles letters of a text.
    void press(Key key);
    void type(const std::string &text);
    /// Number of rows that fit on the screen, for the page keys and for scrolling.
    void set_height(std::size_t rows) { height_ = rows < 1 ? 1 : rows; }

    Page page() const noexcept { return page_; }
    const std::vector<WatchRow> &rows() const noexcept { return rows_; }
    std::size_t cursor() const noexcept { return cursor_; }
    /// First visible row, chosen so that the cursor is on the screen.
    std::size_t top() const noexcept { return top_; }
    const std::string &filter() const noexcept { return filter_; }
    /// The status line: the typed text, an error, or the keys.
    std::string status() const;
    bool isTyping() const noexcept { return is_typing_filter_ || is_typing_value_; }
    bool isDone() const noexcept { return done_; }
    void watch(const std::string &name);
    void open_page(Page page);

  private:
    void add_tree(const std::vector<WatchRow> &leaves);
    void show_pins();
    void show_signals();
    void show_threads();
    void show_watched();
    void clamp();
    void toggle(bool wants_open, bool wants_closed);
    void finish_text();
    Result<> assign(const std::string &name, const std::string &text);

    Instance *hal_;
    Page page_ = Page::PINS;
    std::vector<WatchRow> rows_;
    std::size_t cursor_ = 0, top_ = 0, height_ = 20;
    std::set<std::string> open_;
    std::vector<std::string> watched_;
    std::string filter_, text_, message_;
    bool is_typing_filter_ = false, is_typing_value_ = false, done_ = false;
};

/// One line of a row, cut to `width` columns.
std::string row_text(const WatchRow &row, std::size_t width);

}  // namespace mw::hal::view
