#include <lagroid/run/reports/gnuplot.hpp>
#include <lagroid/run/reports/text.hpp>

#include <boost/algorithm/string/replace.hpp>

namespace lagroid {

std::string gnuplot_string(std::string_view text) {
  return "'" + boost::replace_all_copy(visible(text), "'", "''") + "'";
}

}  // namespace lagroid
