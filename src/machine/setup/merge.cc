// SPDX-License-Identifier: GPL-2.0-or-later
#include "machine/setup/merge.hh"

#include <algorithm>
#include <cstddef>

namespace mw::setup {
namespace {

using Lines = std::vector<std::string_view>;

/// Splits a text into lines, each with its end.
Lines lines_of(std::string_view text) {
    Lines lines;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::size_t size = end == std::string_view::npos ? text.size() : end + 1;
        lines.push_back(text.substr(0, size));
        text.remove_prefix(size);
    }
    return lines;
}

constexpr std::size_t NONE = static_cast<std::size_t>(-1);

/// For each line of `a`, the equal line of `b` in a longest common subsequence, or NONE.
std::vector<std::size_t> matches(const Lines &a, const Lines &b) {
    const std::size_t rows = a.size(), columns = b.size(), width = columns + 1;
    std::vector<std::size_t> length((rows + 1) * width, 0);
    for (std::size_t i = rows; i-- > 0;) {
        for (std::size_t j = columns; j-- > 0;) {
            length[i * width + j] = a[i] == b[j]
                                        ? length[(i + 1) * width + j + 1] + 1
                                        : std::max(length[(i + 1) * width + j], length[i * width + j + 1]);
        }
    }
    std::vector<std::size_t> found(rows, NONE);
    for (std::size_t i = 0, j = 0; i < rows && j < columns;) {
        if (a[i] == b[j]) {
            found[i++] = j++;
        } else if (length[(i + 1) * width + j] >= length[i * width + j + 1]) {
            ++i;
        } else {
            ++j;
        }
    }
    return found;
}

std::string join(const Lines &lines, std::size_t from, std::size_t end) {
    std::string text;
    for (std::size_t i = from; i < end; ++i) {
        text += lines[i];
    }
    return text;
}

class Merger {
  public:
    Merger(std::string_view generated, std::string_view edited, std::string_view wanted, Side side)
        : generated_(lines_of(generated)), edited_(lines_of(edited)), wanted_(lines_of(wanted)),
          in_edited_(matches(generated_, edited_)), in_wanted_(matches(generated_, wanted_)), side_(side) {}

    Merged run() {
        while (base_ < generated_.size() || mine_ < edited_.size() || theirs_ < wanted_.size()) {
            const bool same =
                base_ < generated_.size() && in_edited_[base_] == mine_ && in_wanted_[base_] == theirs_;
            if (same) {
                merged_.text += generated_[base_++];
                ++mine_;
                ++theirs_;
            } else {
                differing();
            }
        }
        return std::move(merged_);
    }

  private:
    /// Processes the lines up to the next line that is in all three texts.
    void differing() {
        std::size_t base = base_;
        while (base < generated_.size() && (in_edited_[base] == NONE || in_wanted_[base] == NONE)) {
            ++base;
        }
        const bool at_end = base == generated_.size();
        const std::size_t mine = at_end ? edited_.size() : in_edited_[base];
        const std::size_t theirs = at_end ? wanted_.size() : in_wanted_[base];
        const std::string before = join(generated_, base_, base);
        const std::string edited = join(edited_, mine_, mine);
        const std::string wanted = join(wanted_, theirs_, theirs);
        if (edited == before || edited == wanted) {
            merged_.text += wanted;
        } else if (wanted == before) {
            merged_.text += edited;
        } else {
            merged_.conflicts.push_back({static_cast<int>(mine_) + 1, before, edited, wanted});
            merged_.text += side_ == Side::EDITED ? edited : wanted;
        }
        base_ = base;
        mine_ = mine;
        theirs_ = theirs;
    }

    Lines generated_, edited_, wanted_;
    std::vector<std::size_t> in_edited_, in_wanted_;
    Side side_;
    std::size_t base_ = 0, mine_ = 0, theirs_ = 0;
    Merged merged_;
};

}  // namespace

Merged merge(std::string_view generated, std::string_view edited, std::string_view wanted, Side side) {
    return Merger(generated, edited, wanted, side).run();
}

}  // namespace mw::setup
