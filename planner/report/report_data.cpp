#include "planner/report/report_data.h"

namespace tenon::planner {

ReportData report_data(const Plan& plan, const Task& task, const Certification& certification,
                       const Validation& validation) {
  const std::vector<Chain>& chains = certification.runs.front().chains;
  ReportData data{plan, task, chains, certification.holds(), validation, {}};
  data.nodes = nodes_of(data.is_baseline() ? finished(validation) : chains, task);
  return data;
}

}  // namespace tenon::planner
