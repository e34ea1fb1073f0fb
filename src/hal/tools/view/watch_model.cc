// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/tools/view/watch_model.hh"

#include <algorithm>

#include <fmt/format.h>

namespace mw::hal::view {

namespace {

constexpr const char *KEYS = "arrows move  enter/space opens  / filter  s set  w watch  tab page  q quit";

std::string link_text(const PinInfo &pin) {
    if (pin.signal.empty()) {
        return "";
    }
    return (pin.dir == Dir::OUT ? "==> " : pin.dir == Dir::IN ? "<== " : "<=> ") + pin.signal;
}

WatchRow row_of(const PinInfo &pin) {
    return {0,
            pin.name,
            pin.name,
            false,
            false,
            fmt::format("{} {}", type_name(pin.type), dir_name(pin.dir)),
            pin.type == Type::PORT ? "" : pin.value.str(),
            link_text(pin)};
}

WatchRow row_of(const ParamInfo &param) {
    return {0,
            param.name,
            param.name,
            false,
            false,
            fmt::format("{} {}", type_name(param.type), dir_name(param.dir)),
            param.value.str(),
            "parameter"};
}

WatchRow row_of(const SignalInfo &signal) {
    std::string writer, readers;
    for (const SignalPin &pin : signal.pins) {
        if (pin.dir == Dir::IN) {
            readers += (readers.empty() ? "" : " ") + pin.name;
        } else {
            writer += (writer.empty() ? "" : " ") + pin.name;
        }
    }
    const std::string link = writer.empty() && readers.empty() ? "" : writer + " ==> " + readers;
    return {0, signal.name, signal.name, false, false, type_name(signal.type), signal.value.str(), link};
}

bool hasText(const WatchRow &row, const std::string &filter) {
    return filter.empty() || row.name.find(filter) != std::string::npos ||
           row.extra.find(filter) != std::string::npos;
}

/// "1234567" ns as "1234.6 us".
std::string micros(std::int64_t ns) {
    return fmt::format("{:.1f} us", static_cast<double>(ns) * 1e-3);
}

std::string number_text(const Result<Value> &value) {
    return value ? micros(value->as_s64()) : "-";
}

}  // namespace

void WatchModel::refresh() {
    rows_.clear();
    switch (page_) {
    case Page::PINS: show_pins(); break;
    case Page::SIGNALS: show_signals(); break;
    case Page::THREADS: show_threads(); break;
    case Page::WATCH: show_watched(); break;
    }
    clamp();
}

void WatchModel::clamp() {
    cursor_ = rows_.empty() ? 0 : std::min(cursor_, rows_.size() - 1);
    if (cursor_ < top_) {
        top_ = cursor_;
    }
    if (cursor_ >= top_ + height_) {
        top_ = cursor_ - height_ + 1;
    }
}

void WatchModel::add_tree(const std::vector<WatchRow> &leaves) {
    std::vector<std::string> path;  // branches open at the current row
    for (const WatchRow &leaf : leaves) {
        // Branches: all parts of the name except the last.
        std::size_t level = 0, begin = 0;
        bool visible = true;
        for (std::size_t dot = leaf.name.find('.'); dot != std::string::npos && visible;
             dot = leaf.name.find('.', begin)) {
            const std::string branch = leaf.name.substr(0, dot);
            // A filter opens all matching branches.
            const bool isOpen = !filter_.empty() || open_.contains(branch);
            if (level >= path.size() || path[level] != branch) {
                path.resize(level);
                path.push_back(branch);
                rows_.push_back({static_cast<int>(level), leaf.name.substr(begin, dot - begin), branch, true,
                                 isOpen, "", "", ""});
            }
            visible = isOpen;
            begin = dot + 1;
            ++level;
        }
        if (visible) {
            path.resize(level);
            rows_.push_back(leaf);
            rows_.back().depth = static_cast<int>(level);
            rows_.back().label = leaf.name.substr(begin);
        }
    }
}

void WatchModel::show_pins() {
    std::vector<WatchRow> leaves;
    for (const PinInfo &pin : hal_->pins().list()) {
        leaves.push_back(row_of(pin));
    }
    for (const ParamInfo &param : hal_->params().list()) {
        leaves.push_back(row_of(param));
    }
    std::erase_if(leaves, [&](const WatchRow &row) { return !hasText(row, filter_); });
    // Sorted by parts of the names, so that the members of a branch are adjacent.
    std::stable_sort(leaves.begin(), leaves.end(), [](const WatchRow &a, const WatchRow &b) {
        return std::lexicographical_compare(
            a.name.begin(), a.name.end(), b.name.begin(), b.name.end(),
            [](char x, char y) { return (x == '.' ? '\0' : x) < (y == '.' ? '\0' : y); });
    });
    add_tree(leaves);
}

void WatchModel::show_signals() {
    for (const SignalInfo &signal : hal_->signals().list()) {
        WatchRow row = row_of(signal);
        if (hasText(row, filter_)) {
            rows_.push_back(std::move(row));
        }
    }
}

void WatchModel::show_threads() {
    for (const ThreadInfo &thread : hal_->threads().list()) {
        rows_.push_back(
            {0, thread.name, thread.name, true, true, "thread", micros(thread.period_ns),
             fmt::format("time {}  tmax {}  overruns {}  latency {}", micros(thread.time_ns),
                         micros(thread.tmax_ns), thread.overruns, micros(thread.max_latency_ns))});
        for (const std::string &function : thread.functions) {
            WatchRow row{1,
                         function,
                         function,
                         false,
                         false,
                         "function",
                         number_text(hal_->values().get(function + ".time")),
                         "tmax " + number_text(hal_->values().get(function + ".tmax"))};
            if (hasText(row, filter_)) {
                rows_.push_back(std::move(row));
            }
        }
    }
}

void WatchModel::show_watched() {
    for (const std::string &name : watched_) {
        if (const auto pin = hal_->pins().find(name)) {
            rows_.push_back(row_of(*pin));
        } else if (const auto param = hal_->params().find(name)) {
            rows_.push_back(row_of(*param));
        } else if (const auto signal = hal_->signals().find(name)) {
            rows_.push_back(row_of(*signal));
        } else {
            rows_.push_back({0, name, name, false, false, "", "gone", ""});
        }
    }
}

void WatchModel::watch(const std::string &name) {
    const auto found = std::find(watched_.begin(), watched_.end(), name);
    if (found != watched_.end()) {
        watched_.erase(found);
        message_ = "no longer watched: " + name;
    } else {
        watched_.push_back(name);
        message_ = "watched: " + name;
    }
}

void WatchModel::open_page(Page page) {
    page_ = page;
    cursor_ = top_ = 0;
}

void WatchModel::toggle(bool wants_open, bool wants_closed) {
    if (rows_.empty()) {
        return;
    }
    const WatchRow &row = rows_[cursor_];
    if (row.is_branch && page_ == Page::PINS) {
        if (!row.isOpen && wants_open) {
            open_.insert(row.name);
        } else if (row.isOpen && wants_closed) {
            open_.erase(row.name);
        }
    } else if (!wants_open && row.depth > 0) {
        // The left key on a leaf moves to its branch.
        while (cursor_ > 0 && rows_[cursor_].depth >= row.depth) {
            --cursor_;
        }
    }
}

void WatchModel::press(Key key) {
    if (isTyping()) {
        if (key == Key::ENTER || key == Key::OPEN) {
            finish_text();
        } else if (key == Key::ESCAPE) {
            is_typing_filter_ = is_typing_value_ = false;
        } else if (key == Key::ERASE && !text_.empty()) {
            text_.pop_back();
        }
        return;
    }
    message_.clear();
    const std::size_t last = rows_.empty() ? 0 : rows_.size() - 1;
    switch (key) {
    case Key::UP: cursor_ -= cursor_ > 0 ? 1 : 0; break;
    case Key::DOWN: cursor_ = std::min(cursor_ + 1, last); break;
    case Key::PAGE_UP: cursor_ -= std::min(cursor_, height_); break;
    case Key::PAGE_DOWN: cursor_ = std::min(cursor_ + height_, last); break;
    case Key::HOME: cursor_ = 0; break;
    case Key::END: cursor_ = last; break;
    case Key::OPEN: toggle(true, false); break;
    case Key::CLOSE: toggle(false, true); break;
    case Key::ENTER:
    case Key::TOGGLE: toggle(true, true); break;
    case Key::NEXT_PAGE: open_page(static_cast<Page>((static_cast<int>(page_) + 1) % 4)); break;
    case Key::WATCH:
        if (!rows_.empty() && !rows_[cursor_].is_branch) {
            watch(rows_[cursor_].name);
        }
        break;
    case Key::FILTER:
        is_typing_filter_ = true;
        text_ = filter_;
        break;
    case Key::SET:
        is_typing_value_ = !rows_.empty() && !rows_[cursor_].is_branch && page_ != Page::THREADS;
        text_.clear();
        break;
    case Key::ESCAPE: filter_.clear(); break;
    case Key::QUIT: done_ = true; break;
    case Key::ERASE:
    case Key::NONE: break;
    }
}

void WatchModel::type(const std::string &text) {
    if (isTyping()) {
        text_ += text;
    }
}

void WatchModel::finish_text() {
    if (is_typing_filter_) {
        filter_ = text_;
        cursor_ = top_ = 0;
    } else if (!rows_.empty()) {
        const std::string name = rows_[cursor_].name;
        const Result<> done = assign(name, text_);
        message_ = done ? fmt::format("{} = {}", name, text_) : done.error().str();
    }
    is_typing_filter_ = is_typing_value_ = false;
}

Result<> WatchModel::assign(const std::string &name, const std::string &text) {
    return hal_->values().get(name) ? hal_->values().set(name, std::string_view(text))
                                    : hal_->signals().set(name, std::string_view(text));
}

std::string WatchModel::status() const {
    if (is_typing_filter_) {
        return "filter: " + text_ + "_";
    }
    if (is_typing_value_) {
        return fmt::format("{} = {}_", rows_.empty() ? "" : rows_[cursor_].name, text_);
    }
    if (!message_.empty()) {
        return message_;
    }
    return filter_.empty() ? KEYS : fmt::format("filter '{}' (escape ends it)  {}", filter_, KEYS);
}

std::string row_text(const WatchRow &row, std::size_t width) {
    const std::string mark = row.is_branch ? (row.isOpen ? "- " : "+ ") : "  ";
    const std::string label = std::string(static_cast<std::size_t>(row.depth) * 2, ' ') + mark + row.label;
    std::string text = fmt::format("{:<40} {:>14}  {:<9} {}", label, row.value, row.type, row.extra);
    if (text.size() > width) {
        text.resize(width);
    }
    return text;
}

}  // namespace mw::hal::view
