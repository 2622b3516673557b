#include "executor/export/export_log.h"

#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>

#include "executor/export/csv_run.h"
#include "executor/export/log_scan.h"
#include "executor/export/mcap_run.h"
#include "executor/record/channels.h"
#include "executor/recorded/event_file.h"
#include "lcmtypes/received/received.h"
#include "shared/base/error.h"
#include "shared/base/text.h"
#include "shared/system/new_file.h"

namespace tenon::executor {
namespace {

unsigned long long shown(std::uint64_t count) { return count; }

const LoggedRun& run_of(const ExportRequest& request, const LogScan& scan) {
  if (!request.run) return scan.runs.back();
  if (*request.run < 1 || *request.run > scan.runs.size()) {
    throw InputError(format("%s: has no run %zu: it holds %zu", request.log.c_str(), *request.run,
                            scan.runs.size()));
  }
  return scan.runs[*request.run - 1];
}

std::vector<std::string> what_is_missing(const ExportRequest& request, const LogScan& scan,
                                         const LoggedRun& run) {
  std::vector<std::string> lines;
  const std::string log = request.log.string() + ": ";
  const double length_s = seconds(run.since_ns(run.last_ns));
  if (!scan.damage.empty()) {
    lines.push_back(scan.damage + "; what stands before is written");
  } else if (scan.breaks_off) {
    lines.push_back(log + format("breaks off within a message after %.2f s; what stands before is "
                                 "written",
                                 length_s));
  }
  if (scan.malformed > 0) {
    lines.push_back(log +
                    format("%llu messages make no sense and are left out", shown(scan.malformed)));
  }
  return lines;
}

std::vector<std::string> what_the_log_lacks(const ExportRequest& request, const LogScan& scan,
                                            const LoggedRun& run) {
  std::vector<std::string> lines;
  if (scan.runs.size() > 1 && !request.run) {
    lines.push_back(
        format("The log holds %zu runs; this is the last, --run takes another.", scan.runs.size()));
  }
  if (!run.ended) lines.push_back("The log ends before the run does.");
  if (!run.setup) lines.push_back("The log does not name the joints, nor say what is measured by.");
  return lines;
}

/// Leads a run's messages to the writers.
class RunReader {
 public:
  RunReader(const LoggedRun& run, std::vector<RunWriter*> writers)
      : run_(run), writers_(std::move(writers)), events_(run.joints()) {}

  void take(const LoggedEvent& event) {
    if (event.channel == kCycleChannel) lead<tenon::cycle_state_t>(event);
    if (event.channel == kStepChannel) lead<tenon::step_event_t>(event);
    if (event.channel == kStatusChannel) lead<tenon::run_status_t>(event);
    if (event.channel == kSetupChannel) lead<tenon::run_setup_t>(event);
    if (event.channel == kRunChannel) lead<tenon::run_summary_t>(event);
  }

  [[nodiscard]] std::uint64_t cycles() const { return cycles_; }
  [[nodiscard]] std::uint64_t twice() const { return twice_; }

 private:
  template <typename Message>
  void lead(const LoggedEvent& event) {
    std::optional<Message> message = decoded<Message>(event.message);
    if (!message) return;
    // What the network has brought twice, or late, has been told.
    std::int64_t& last = std::get<Last<Message>>(last_).sequence;
    if (message->sequence <= last) {
      ++twice_;
      return;
    }
    last = message->sequence;
    if (std::is_same_v<Message, tenon::cycle_state_t>) ++cycles_;
    const std::int64_t since_ns = run_.since_ns(message->monotonic_ns);
    const Timed<Message> told{*std::move(message), event.time_us, since_ns};
    const std::vector<RunEvent> events = events_.of(told.message);
    for (RunWriter* writer : writers_) {
      writer->take(told);
      for (const RunEvent& happened : events) writer->take(happened, told.since_ns);
    }
  }
  template <typename Message>
  struct Last {
    std::int64_t sequence = -1;
  };

  const LoggedRun& run_;
  std::vector<RunWriter*> writers_;
  RunEvents events_;
  std::tuple<Last<tenon::cycle_state_t>, Last<tenon::step_event_t>, Last<tenon::run_status_t>,
             Last<tenon::run_setup_t>, Last<tenon::run_summary_t>>
      last_;
  std::uint64_t cycles_ = 0;
  std::uint64_t twice_ = 0;
};

/// A file that is made, and who makes it.
template <typename Writer>
struct Made {
  NewFile file;
  Writer writer;

  template <typename... Arguments>
  explicit Made(const std::filesystem::path& name, Arguments&&... arguments)
      : file(name),
        writer([this](std::string_view bytes) { file.add(bytes); },
               std::forward<Arguments>(arguments)...) {}
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;
};

std::string one_text(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

}  // namespace

Exported export_log(const ExportRequest& request) {
  for (const auto& file : {request.csv, request.mcap}) {
    if (!file.empty()) NewFile::check(file);
  }
  const LogScan scan = scan_log(request.log);
  const LoggedRun& run = run_of(request, scan);
  Exported exported{
      {}, what_is_missing(request, scan, run), what_the_log_lacks(request, scan, run)};

  const Columns<tenon::cycle_state_t> columns = cycle_columns(run.joints(), run.setup);
  std::unique_ptr<Made<CsvRun>> csv;
  std::unique_ptr<Made<McapRun>> mcap;
  std::vector<RunWriter*> writers;
  if (!request.csv.empty()) {
    csv = std::make_unique<Made<CsvRun>>(request.csv, columns);
    writers.push_back(&csv->writer);
  }
  if (!request.mcap.empty()) {
    mcap = std::make_unique<Made<McapRun>>(request.mcap, request.version, run);
    writers.push_back(&mcap->writer);
  }

  RunReader reader(run, std::move(writers));
  EventFile events(request.log);
  for (std::size_t i = 0; i < run.end_event; ++i) {
    const std::optional<LoggedEvent> event = events.next();
    if (!event) break;
    if (i >= run.first_event) reader.take(*event);
  }
  if (reader.twice() > 0) {
    exported.missing.push_back(
        request.log.string() +
        format(": %llu messages came twice or late and are left out", shown(reader.twice())));
  }

  const std::string size =
      format("%llu cycles, %.2f s", shown(reader.cycles()), seconds(run.since_ns(run.last_ns)));
  if (csv) {
    csv->writer.finish();
    csv->file.finish();
    exported.written.push_back(request.csv.string() + ": " + size +
                               format(", %zu columns", columns.all().size() + 2));
  }
  if (mcap) {
    mcap->writer.finish(request.log.filename().string(), one_text(exported.missing));
    mcap->file.finish();
    exported.written.push_back(request.mcap.string() + ": " + size +
                               format(", %llu messages", shown(mcap->writer.messages())));
  }
  return exported;
}

}  // namespace tenon::executor
