// SPDX-License-Identifier: GPL-2.0-or-later
// Tests of components as tables: in each row some inputs are set, one period passes, and outputs are
// compared.
#pragma once

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "components/test/bench.hh"

namespace mw::components::test {

struct Row {
    std::string set;     ///< "in=1 reset=0"
    std::string expect;  ///< "out=0.5"; values are compared with a relative tolerance of 1e-6
    int periods = 1;
};

struct Table {
    std::string name;    ///< name of the test
    std::string load;    ///< "integ" or "gantry personality=2"
    std::string prefix;  ///< prefix of the pins, "integ.0"
    std::vector<std::string> functions;
    std::string setup;  ///< pins and parameters that are set before, as in a row
    std::vector<Row> rows;
};

inline void PrintTo(const Table &table, std::ostream *out) {
    *out << table.name;
}

class TableBench {
  public:
    explicit TableBench(const Table &table) : table_(table), bench_(commands(table)) { assign(table.setup); }

    void run() {
        for (std::size_t i = 0; i < table_.rows.size(); ++i) {
            const Row &row = table_.rows[i];
            assign(row.set);
            bench_.pass(row.periods);
            std::istringstream words(row.expect);
            for (std::string word; words >> word;) {
                const std::size_t equals = word.find('=');
                const double wanted = std::stod(word.substr(equals + 1));
                const double got = bench_.get(table_.prefix + "." + word.substr(0, equals));
                EXPECT_NEAR(got, wanted, 1e-6 * std::fmax(1.0, std::fabs(wanted)))
                    << table_.load << ", row " << i << " (" << row.set << "): " << word;
            }
        }
    }
    Bench &bench() { return bench_; }

    /// "in=1 reset=0"
    void assign(const std::string &text) {
        std::istringstream words(text);
        for (std::string word; words >> word;) {
            const std::size_t equals = word.find('=');
            bench_.set(table_.prefix + "." + word.substr(0, equals), std::stod(word.substr(equals + 1)));
        }
    }

  private:
    static std::string commands(const Table &table) {
        std::string text = "loadrt " + table.load;
        for (const std::string &function : table.functions) {
            text += "\naddf " + function + " t";
        }
        return text;
    }

    const Table &table_;
    Bench bench_;
};

/// A suite of tables: TABLE_SUITE(Gates) with `const std::vector<Table> GATES = {...}`.
#define MW_TABLE_SUITE(Suite, tables)                                                                        \
    class Suite : public ::testing::TestWithParam<Table> {};                                                 \
    TEST_P(Suite, FollowsItsTable) {                                                                         \
        TableBench bench(GetParam());                                                                        \
        bench.run();                                                                                         \
    }                                                                                                        \
    INSTANTIATE_TEST_SUITE_P(All, Suite, ::testing::ValuesIn(tables),                                        \
                             [](const auto &test) { return test.param.name; })

}  // namespace mw::components::test
