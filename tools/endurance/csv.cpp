#include "tools/endurance/csv.hpp"

namespace gvom::endurance {

Csv::Csv(const std::string& folder)
    : processes_(folder + "/processes.csv"), bus_(folder + "/bus.csv"), faults_(folder + "/faults.csv") {
  processes_ << "time_s,process,private_bytes,descriptors,threads,minor_faults,major_faults,"
                "voluntary_switches,involuntary_switches,cpu_s\n";
  bus_ << "time_s,layers_per_s,packets_per_s,layers_age_ms,latency_p50_ms,latency_max_ms,chunks_used,rounds,"
          "clean_rounds,lost_and_counted\n";
  faults_ << "time_s,well_again_after_s,fault\n";
}

void Csv::add(double at_s, const std::string& process, const ProcessSample& sample) {
  processes_ << at_s << ',' << process << ',' << sample.private_bytes << ',' << sample.descriptors << ','
             << sample.threads << ',' << sample.minor_faults << ',' << sample.major_faults << ','
             << sample.voluntary_switches << ',' << sample.involuntary_switches << ',' << sample.cpu_s
             << '\n';
}

void Csv::add(const BusSample& sample) {
  bus_ << sample.at_s << ',' << sample.layers_hz << ',' << sample.packets_hz << ',' << sample.age_ms << ','
       << sample.latency_p50_ms << ',' << sample.latency_max_ms << ',' << sample.chunks_used << ','
       << sample.rounds << ',' << sample.clean << ',' << sample.lost << std::endl;
  processes_.flush();
}

void Csv::add_fault(double at_s, double recovered_s, const std::string& what) {
  faults_ << at_s << ',' << recovered_s << ',' << what << std::endl;
}

}  // namespace gvom::endurance
