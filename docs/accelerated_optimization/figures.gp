# Draws curves.csv and costs.csv; run by lagroid, or by hand: gnuplot figures.gp
set datafile separator ','
set grid

set terminal svg size 1040,1200 background 'white' noenhanced
set output 'figure_1.svg'
set multiplot layout 2,2
set logscale xy
set format y '%.0e'
set yrange [1e-14:*]
set xlabel 'iteration'
set key below
set title 'Rayleigh: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 1 direct') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 direct', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 2 I') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 I', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 2 II') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 II', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'gradient descent by h') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by h', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 1 adaptive uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 1 adaptive uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 2 I uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 I uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 2 II uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 II uncapped'
set title 'Brockett: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 1 direct') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 direct', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 2 I') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 I', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 2 II') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 II', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'gradient descent by h') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by h', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 1 adaptive uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 1 adaptive uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 2 I uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 I uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 2 II uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 II uncapped'
set title 'unbalanced Procrustes: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 1 direct') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 direct', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 2 I') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 I', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 2 II') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 II', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'gradient descent by h') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by h', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 1 adaptive uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 1 adaptive uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 2 I uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 I uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 2 II uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 II uncapped'
set title 'balanced Procrustes: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 1 direct') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 direct', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 2 I') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 I', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 2 II') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 2 II', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'gradient descent by h') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by h', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 1 adaptive uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 1 adaptive uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 2 I uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 I uncapped', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 2 II uncapped') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5 dashtype 2 title 'Algorithm 2 II uncapped'
unset multiplot
set output
unset logscale
set yrange [*:*]

set terminal svg size 1040,1200 background 'white' noenhanced
set output 'tuned.svg'
set multiplot layout 2,2
set logscale xy
set format y '%.0e'
set yrange [1e-14:*]
set xlabel 'iteration'
set key below
set title 'Rayleigh: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'robust') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'robust', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'Nesterov with restarts') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Nesterov with restarts', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'gradient descent by 1 / L') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by 1 / L', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'gradient descent with line search') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent with line search', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'conjugate gradients') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'conjugate gradients', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Rayleigh') && (strcol('method') eq 'trust region') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'trust region'
set title 'Brockett: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'robust') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'robust', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'Nesterov with restarts') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Nesterov with restarts', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'gradient descent by 1 / L') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by 1 / L', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'gradient descent with line search') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent with line search', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'conjugate gradients') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'conjugate gradients', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'Brockett') && (strcol('method') eq 'trust region') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'trust region'
set title 'unbalanced Procrustes: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'robust') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'robust', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'Nesterov with restarts') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Nesterov with restarts', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'gradient descent by 1 / L') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by 1 / L', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'gradient descent with line search') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent with line search', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'conjugate gradients') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'conjugate gradients', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'unbalanced Procrustes') && (strcol('method') eq 'trust region') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'trust region'
set title 'balanced Procrustes: f above its minimum'
plot 'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Algorithm 1 adaptive') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Algorithm 1 adaptive', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'robust') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'robust', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'Nesterov with restarts') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'Nesterov with restarts', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'gradient descent by 1 / L') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent by 1 / L', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'gradient descent with line search') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'gradient descent with line search', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'conjugate gradients') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'conjugate gradients', \
  'curves.csv' using (column('iteration') + 1):((strcol('problem') eq 'balanced Procrustes') && (strcol('method') eq 'trust region') && (column('gap') > 0) ? column('gap') : NaN) with lines linewidth 1.5  title 'trust region'
unset multiplot
set output
unset logscale
set yrange [*:*]

set terminal svg size 1040,500 background 'white' noenhanced
set output 'costs.svg'
set multiplot layout 1,2
set logscale xy
set ylabel 's of an iteration, without the gradient of f'
set key below
set xlabel 'n'
set title 'm = 20'
plot 'costs.csv' using (column('m') == 20 ? column('n') : NaN):'ours' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'Algorithm 1, robust', \
  'costs.csv' using (column('m') == 20 ? column('n') : NaN):'descent' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'gradient descent, QR', \
  'costs.csv' using (column('m') == 20 ? column('n') : NaN):'multipliers' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'step with multipliers alone', \
  'costs.csv' using (column('m') == 20 ? column('n') : NaN):'qr' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'QR retraction alone'
set xlabel 'm'
set title 'n = 2000'
plot 'costs.csv' using (column('n') == 2000 ? column('m') : NaN):'ours' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'Algorithm 1, robust', \
  'costs.csv' using (column('n') == 2000 ? column('m') : NaN):'descent' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'gradient descent, QR', \
  'costs.csv' using (column('n') == 2000 ? column('m') : NaN):'multipliers' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'step with multipliers alone', \
  'costs.csv' using (column('n') == 2000 ? column('m') : NaN):'qr' smooth unique with linespoints pointtype 7 pointsize 0.5 title 'QR retraction alone'
unset multiplot
set output
