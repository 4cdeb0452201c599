# Draws the CSV of helixnav_mrpt_side_by_side:
#   gnuplot -e "csv='side_by_side.csv'; png='docs/mrpt_side_by_side.png'" bench/mrpt/mrpt_side_by_side.gp
set datafile separator ","
set terminal pngcairo size 1000,650 font "sans,13"
set output png
set logscale xy
set xrange [85:950]
set xtics (100, 200, 400, 800)
set grid ytics mytics xtics
set format y "%g"
set xlabel "landmarks in the map"
set ylabel "ms per update (predict + update, median)"
set title "Known association, one circle world, in one run; dashed: mean with region switches"
set key left top
names = "mrpt_naive mrpt_davison cekf_standard cekf_right_invariant"
colours = "#b03030 #d08020 #3070b0 #207040"
plot for [i=1:4] "< grep ".word(names, i)." ".csv using 1:3 with linespoints lw 2.5 pt 7 lc rgb word(colours, i) \
       title word(names, i) noenhanced, \
     for [i=3:4] "< grep ".word(names, i)." ".csv using 1:5 with linespoints lw 1.5 pt 6 dt 2 lc rgb word(colours, i) \
       title word(names, i)." mean" noenhanced
