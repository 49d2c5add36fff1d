#include "gnuplot.hpp"

#include "text.hpp"

#include <boost/algorithm/string/replace.hpp>

namespace lagroid::app {

std::string gnuplot_string(std::string_view text) {
  return "'" + boost::replace_all_copy(visible(text), "'", "''") + "'";
}

}  // namespace lagroid::app
