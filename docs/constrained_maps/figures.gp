# Draws errors.csv; run by lagroid, or by hand: gnuplot figures.gp
set datafile separator ','
set grid
set terminal svg size 1040,620 background 'white' noenhanced
set output 'errors.svg'
set multiplot layout 1,2
set logscale xy
set format y '%.0e'
set xlabel 'steps'
set key below
set title 'spherical pendulum: error in q'
plot 'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'type II r = 0') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 0', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'type III r = 0') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type III r = 0', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'type I trapezoid (RATTLE)') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type I trapezoid (RATTLE)', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'type II r = 1 trapezoid') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 1 trapezoid', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'type II r = 2 Gauss') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 2 Gauss', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'type II r = 3 Gauss') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 3 Gauss', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'RATTLE triple jump') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'RATTLE triple jump', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'RATTLE Suzuki') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'RATTLE Suzuki', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'spherical pendulum') && (strcol('method') eq 'types II and III r = 0 Suzuki') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'types II and III r = 0 Suzuki'
set title 'planar pendulum: error in q'
plot 'errors.csv' using (column('steps')):((strcol('problem') eq 'planar pendulum') && (strcol('method') eq 'type II r = 0') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 0', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'planar pendulum') && (strcol('method') eq 'type II r = 1') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 1', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'planar pendulum') && (strcol('method') eq 'type II r = 2') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 2', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'planar pendulum') && (strcol('method') eq 'type II r = 3') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 3', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'planar pendulum') && (strcol('method') eq 'type II r = 4') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 4', \
  'errors.csv' using (column('steps')):((strcol('problem') eq 'planar pendulum') && (strcol('method') eq 'type II r = 4 trapezoid') && (column('q') > 0) ? column('q') : NaN) with linespoints pointtype 7 pointsize 0.5 title 'type II r = 4 trapezoid'
unset multiplot
set output
