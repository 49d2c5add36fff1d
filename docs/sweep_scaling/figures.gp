# Draws model.csv; run by lagroid, or by hand: gnuplot figures.gp
set datafile separator ','
set grid
set terminal svg size 720,480 background 'white' noenhanced
set output 'efficiency.svg'
set logscale x
set xlabel 'threads'
set ylabel 'efficiency'
set yrange [0:1.02]
set key bottom left
plot 'model.csv' using (column('threads')):(column('4 parts')) with lines linewidth 1.5 title '4 parts a thread', 'model.csv' using (column('threads')):(column('16 parts')) with lines linewidth 1.5 title '16 parts a thread', 'model.csv' using (column('threads')):(column('64 parts')) with lines linewidth 1.5 title '64 parts a thread', 'model.csv' using (column('threads')):(column('256 parts')) with lines linewidth 1.5 title '256 parts a thread'
set output
