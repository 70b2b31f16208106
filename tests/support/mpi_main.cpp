// SPDX-License-Identifier: BSD-3-Clause
// The main of every MPI test: all ranks run the same Catch2 cases; one rank's failure fails the
// run.
//
// Rank 0 prints Catch2's report; the other ranks print a line for each failed assertion, at once,
// so that it is seen even if the run hangs afterwards. A run that takes longer than
// $CARROM_TEST_SECONDS is killed by its own alarm.
#define CARROM_CATCH_MAIN
#include "catch.hpp"

#include <cstdlib>
#include <iostream>
#include <sstream>

#include <unistd.h>

#include "parallel/communicator.hpp"
#include "parallel/mpi.hpp"

namespace {

int test_rank = 0;

class FailurePrinter : public TestListener {
public:
    using TestListener::TestListener;

    void testCaseStarting(const Catch::TestCaseInfo& info) override { case_ = info.name; }

    AfterAssertion assertionEnded(const Catch::AssertionStats& stats) override {
        const Catch::AssertionResult& result = stats.assertionResult;
        if (test_rank == 0 || result.isOk()) return AfterAssertion();
        std::ostringstream line;
        line << "rank " << test_rank << ": " << case_ << ": " << result.getSourceInfo().file << ':'
             << result.getSourceInfo().line << ": " << result.getExpression() << " is "
             << result.getExpandedExpression() << ' ' << result.getMessage() << '\n';
        std::cerr << line.str() << std::flush;
        return AfterAssertion();
    }

private:
    std::string case_;
};
CATCH_REGISTER_LISTENER(FailurePrinter)

} // namespace

int main(int argc, char** argv) {
    const char* const seconds = std::getenv("CARROM_TEST_SECONDS");
    alarm(seconds != nullptr ? static_cast<unsigned>(std::atoi(seconds)) : 120);

    carrom::Mpi mpi(argc, argv);
    return carrom::run_on_all(carrom::Communicator::world(),
                              [&](const carrom::Communicator& communicator) {
                                  test_rank = communicator.rank();
                                  std::ostringstream unseen;
                                  std::streambuf* const seen = std::cout.rdbuf();
                                  if (!communicator.is_root()) std::cout.rdbuf(unseen.rdbuf());
                                  const int n_failed = Catch::Session().run(argc, argv);
                                  std::cout.rdbuf(seen);
                                  return n_failed == 0 ? 0 : 1;
                              });
}
