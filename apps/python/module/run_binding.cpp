#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "module/bindings.h"
#include "module/table.h"
#include "runs/interrupted.h"
#include "runs/run_report.h"

namespace stopline::python {

namespace {

namespace py = pybind11;

// Runs all populations of a scenario in a thread of its own. This thread never needs Python's interpreter lock.
class BackgroundRun {
public:
    BackgroundRun(Scenario scenario, int wanted_threads)
        : scenario_(std::move(scenario)),
          result_(std::async(std::launch::async, [this, threads = checked_threads(wanted_threads)] {
                      const int all = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
                      return run_report(scenario_, threads > 0 ? threads : all, [this](double share) {
                          progress_ = share;
                          return !is_cancelled_;
                      });
                  }).share()) {}
    ~BackgroundRun() { is_cancelled_ = true; }  // the future waits for the thread
    BackgroundRun(const BackgroundRun&) = delete;
    BackgroundRun& operator=(const BackgroundRun&) = delete;
    BackgroundRun(BackgroundRun&&) = delete;
    BackgroundRun& operator=(BackgroundRun&&) = delete;

    double progress() const { return is_done() ? 1.0 : progress_.load(); }
    bool is_done() const { return result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
    void cancel() { is_cancelled_ = true; }

    // Waits for the end. Other Python threads run meanwhile, and Ctrl-C cancels the run.
    void wait() {
        while (!is_done()) {
            {
                const py::gil_scoped_release other_threads_run;
                result_.wait_for(std::chrono::milliseconds(50));
            }
            if (PyErr_CheckSignals() != 0) {
                cancel();
                throw py::error_already_set();
            }
        }
        report();
    }

    // Returns the tables by name, without ".csv". Waits for the end.
    const std::map<std::string, std::shared_ptr<Table>>& tables() {
        wait();
        if (!tables_.empty()) return tables_;
        for (const auto& [file, text] : report().tables) {
            const std::string name = file.substr(0, file.rfind('.'));
            tables_[name] = std::make_shared<Table>(table_of_csv(name, text));
        }
        return tables_;
    }
    std::map<std::string, std::string> hashes() {
        wait();
        return {report().state_hashes.begin(), report().state_hashes.end()};
    }
    bool passes() {
        wait();
        return report().passes;
    }

private:
    static int checked_threads(int threads) {
        if (threads < 0 || threads > kMaxThreads)
            throw std::invalid_argument(fmt::format("{} threads: allowed are 0 to {}", threads, kMaxThreads));
        return threads;
    }
    const RunReport& report() const {
        try {
            return result_.get();
        } catch (const Interrupted&) {
            throw std::runtime_error("the run was cancelled");
        }
    }

    Scenario scenario_;
    std::atomic<double> progress_{0.0};
    std::atomic<bool> is_cancelled_{false};
    std::map<std::string, std::shared_ptr<Table>> tables_;
    std::shared_future<RunReport> result_;  // the last member: it is destroyed first, and waits for the thread
};

}  // namespace

void bind_run(py::module_& module) {
    py::class_<BackgroundRun>(module, "Run", "The runs of all populations of a scenario, in the background.")
        .def(py::init<Scenario, int>(), py::arg("scenario"), py::arg("threads") = 0)
        .def_property_readonly("progress", &BackgroundRun::progress, "completed share, 0 to 1")
        .def_property_readonly("done", &BackgroundRun::is_done)
        .def(
            "wait",
            [](BackgroundRun& run) -> BackgroundRun& {
                run.wait();
                return run;
            },
            py::return_value_policy::reference_internal, "Waits for the end and returns the Run.")
        .def("cancel", &BackgroundRun::cancel, "Stops the run. wait() then raises RuntimeError.")
        .def_property_readonly("tables", &BackgroundRun::tables,
                               "the tables by name, such as 'summary'; waits for the end")
        .def_property_readonly("state_hashes", &BackgroundRun::hashes,
                               "hash of the final state of each population, as in NAME.provenance.json of stopline-run")
        .def_property_readonly("passes", &BackgroundRun::passes,
                               "True if no violation has occurred and no movement starves")
        .def("__repr__", [](const BackgroundRun& run) {
            return fmt::format("<stopline.Run, {:.0f} % done>", 100.0 * run.progress());
        });
}

}  // namespace stopline::python
