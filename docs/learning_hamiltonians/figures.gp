# Draws fits.csv; run by lagroid, or by hand: gnuplot figures.gp
set datafile separator ','
set grid
set terminal svg size 1040,620 background 'white' noenhanced
set output 'errors.svg'
set multiplot layout 1,2
set logscale xy
set format y '%.0e'
set ylabel 'test MSE'
set key below
set title 'without noise, M = 5'
set xlabel 'N'
plot 'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'CF4') ? column('published_test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5 dashtype 2 title 'CF4, published', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'CF4') && (strcol('model') eq 'network:8') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'CF4, network:8', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'CF4') && (strcol('model') eq 'polynomial:2') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'CF4, polynomial:2', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'RK4') ? column('published_test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5 dashtype 2 title 'RK4, published', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'RK4') && (strcol('model') eq 'network:8') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'RK4, network:8', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'RK4') && (strcol('model') eq 'polynomial:2') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'RK4, polynomial:2', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'LE') ? column('published_test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5 dashtype 2 title 'LE, published', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'LE') && (strcol('model') eq 'network:8') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'LE, network:8', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'LE') && (strcol('model') eq 'polynomial:2') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'LE, polynomial:2', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'EE') ? column('published_test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5 dashtype 2 title 'EE, published', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'EE') && (strcol('model') eq 'network:8') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'EE, network:8', \
  'fits.csv' using (column('N')):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('noise') == 0) && (column('M') == 5)) && (strcol('integrator') eq 'EE') && (strcol('model') eq 'polynomial:2') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'EE, polynomial:2'
set title 'CF4, M = 5, N = 1500'
set xlabel 'noise'
plot 'fits.csv' using (column('noise') + 1e-4):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('N') == 1500) && (column('M') == 5)) && (strcol('integrator') eq 'CF4') ? column('published_test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5 dashtype 2 title 'CF4, published', \
  'fits.csv' using (column('noise') + 1e-4):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('N') == 1500) && (column('M') == 5)) && (strcol('integrator') eq 'CF4') && (strcol('model') eq 'network:8') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'CF4, network:8', \
  'fits.csv' using (column('noise') + 1e-4):(((strcol('part') eq 'study') && (column('bodies') == 1) && (column('N') == 1500) && (column('M') == 5)) && (strcol('integrator') eq 'CF4') && (strcol('model') eq 'polynomial:2') ? column('test_mse') : NaN) smooth unique with linespoints pointtype 7 pointsize 0.5  title 'CF4, polynomial:2'
unset multiplot
set output
