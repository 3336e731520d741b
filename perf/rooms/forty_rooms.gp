# forty_rooms.gp: the figures of the forty rooms from results.csv, as SVG and PNG, after those of Neilson & Yang
# (TR 04-21, 2004): time per room; speed-up per room, with the share of the photons below it.
# Use: gnuplot -e "folder='DIR'" [-e "gather=16"] forty_rooms.gp
# Reads DIR/results.csv; writes DIR/time.png, DIR/time.svg, DIR/speedup.png, DIR/speedup.svg.
# Times are of emission + map + irradiance + picture, the sum that the paper compares.

if (!exists("folder")) folder = "."
csv = folder . "/results.csv"
gathers = system("awk -F, 'NR > 1 { print $2 }' '" . csv . "' | sort -nu | tr '\n' ' '")
if (words(gathers) == 0) exit error csv . " holds no measurement"
# The figure of times shows one gather count: 16 where it was measured, else the greatest.
if (!exists("gather")) {
    gather = int(word(gathers, words(gathers)))
    do for [g in gathers] { if (int(g) == 16) { gather = 16 } }
}

set datafile separator comma
set datafile columnheaders
set datafile missing NaN
pick(mode, g, name) = strcol("mode") eq mode && column("gather") == g ? column(name) : NaN

# Extent of a mode's times at the gather count shown; 0 where it was not measured.
extent(mode, sign) = real(system(sprintf("awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == \"sum_s\") c = i } \
    NR > 1 && $3 == \"%s\" && $2 == %d && (x == \"\" || %d * ($c - x) > 0) { x = $c } END { print x + 0 }' '%s'", \
    mode, gather, sign, csv)))
cached_top = extent("precompute", 1) > extent("on-demand", 1) ? extent("precompute", 1) : extent("on-demand", 1)
off_top = extent("off", 1)
# Without a cache it can take ten times as long: then its range is told in words, and the scale left to the others.
off_fits = off_top > 0.0 && (off_top <= 2.0 * cached_top || cached_top == 0.0)
time_top = 1.25 * (off_fits && off_top > cached_top ? off_top : cached_top)
if (time_top == 0.0) time_top = 1.25 * off_top

shown = (off_fits ? "off " : "") . (extent("precompute", 1) > 0.0 ? "precompute " : "") . \
    (extent("on-demand", 1) > 0.0 ? "on-demand" : "")
style_of(mode) = mode eq "on-demand" ? 1 : mode eq "precompute" ? 2 : 3
title_of(mode) = mode eq "on-demand" ? "on demand" : mode eq "off" ? "without a cache" : mode

# A speed-up needs both modes of a room; they stand on different lines of the file.
speed_ups = "< awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == \"sum_s\") c = i } \
    BEGIN { print \"room,gather,speed_up\" } NR > 1 { t[$1 \",\" $2, $3] = $c; k[$1 \",\" $2] } \
    END { for (i in k) if (((i, \"on-demand\") in t) && \
    ((i, \"precompute\") in t)) print i \",\" t[i, \"precompute\"] / t[i, \"on-demand\"] }' \
    '" . csv . "' | sort -t, -k2n -k1n"
pair_count = int(system(speed_ups[3:] . " | wc -l")) - 1
speed_up(g) = column("gather") == g ? column("speed_up") : NaN

ink = "#333333"
set style line 1 lc rgb "#0072b2" lw 2.2 pt 7 ps 0.7  # on demand
set style line 2 lc rgb "#d55e00" lw 2.2 pt 5 ps 0.65 # precompute
set style line 3 lc rgb "#7f7f7f" lw 1.6 pt 9 ps 0.7  # without a cache
# Gather counts: more rays, more ink.
shades = "#9cc9e3 #4aa3d6 #0b6bb0 #002b52"
shade(i) = word(shades, words(gathers) <= 4 ? i + 4 - words(gathers) : (i - 1) % 4 + 1)
plural(g) = int(g) == 1 ? "" : "s"

set border 3 lc rgb ink
set tics nomirror out scale 0.6 textcolor rgb ink
set grid ytics lc rgb "#e4e4e4" lw 1 lt 1
set xrange [0.25:40.75]
set xtics (1, 5, 10, 15, 20, 25, 30, 33, 35, 40)
set title textcolor rgb ink
set ylabel textcolor rgb ink

do for [format in "png svg"] {
    if (format eq "png") {
        set terminal pngcairo noenhanced size 1500,840 font "DejaVu Sans,15" linewidth 1.5 background rgb "white"
    } else {
        set terminal svg noenhanced size 1000,560 font "DejaVu Sans,Arial,sans-serif,13" background rgb "white"
    }
    set output folder . "/time." . format
    set key notitle top left Left reverse samplen 2.5 spacing 1.2 textcolor rgb ink
    set title sprintf("Time per room, %d gather ray%s at each gather point", gather, plural(gather))
    set xlabel "room (number of spheres)" textcolor rgb ink
    set ylabel "emission + map + irradiance + picture, seconds"
    set yrange [0:time_top]
    if (off_top > 0.0 && !off_fits) {
        set label 1 sprintf("without a cache: %.3g to %.3g s, beyond this figure", extent("off", -1), off_top) \
            at graph 0.985, graph 0.96 right textcolor rgb "#7f7f7f"
    }
    set arrow 1 from 33, graph 0 to 33, graph 0.8 nohead lc rgb "#bbbbbb" lw 1 dt 3 back
    set label 2 "large sphere\nunder the light" at 33, graph 0.86 center textcolor rgb "#888888" font ",11"
    plot for [mode in shown] csv using (column("room")):(pick(mode, gather, "sum_s")) \
        with linespoints linestyle style_of(mode) title title_of(mode)
    unset label
    unset arrow

    # Without a pair of modes there is no speed-up to show.
    if (pair_count == 0) { continue }
    if (format eq "png") {
        set terminal pngcairo noenhanced size 1500,1200 font "DejaVu Sans,15" linewidth 1.5 background rgb "white"
    } else {
        set terminal svg noenhanced size 1000,800 font "DejaVu Sans,Arial,sans-serif,13" background rgb "white"
    }
    set output folder . "/speedup." . format
    set multiplot
    set lmargin at screen 0.08
    set rmargin at screen 0.86

    set tmargin at screen 0.945
    set bmargin at screen 0.45
    set key title "gather rays" at screen 0.985, screen 0.94 top right Left reverse samplen 1.8 \
        spacing 1.2 textcolor rgb ink
    set title "Speed-up of on demand over precompute"
    unset xlabel
    set ylabel "time of precompute / time of on demand"
    set yrange [0:2.4<*]
    # The paper's range, and the line of equal time.
    set object 1 rectangle from graph 0, first 1.2 to graph 1, first 2.2 behind \
        fillcolor rgb "#f6efd9" fillstyle solid noborder
    set label 1 "the paper: 1.2 to 2.2" at graph 0.01, first 2.12 textcolor rgb "#a08a45" font ",11"
    set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead lc rgb "#999999" lw 1 back
    plot for [i = 1:words(gathers)] speed_ups using (column("room")):(speed_up(int(word(gathers, i)))) \
        with linespoints lc rgb shade(i) lw 2 pt 7 ps 0.6 title word(gathers, i)
    unset object
    unset label
    unset arrow

    set tmargin at screen 0.355
    set bmargin at screen 0.075
    unset key
    set title "Share of the photons whose irradiance was asked for"
    set xlabel "room (number of spheres)" textcolor rgb ink
    set ylabel "computed / stored"
    set yrange [0:1]
    plot for [i = 1:words(gathers)] csv using (column("room")):(pick("on-demand", int(word(gathers, i)), "share")) \
        with linespoints lc rgb shade(i) lw 2 pt 7 ps 0.6 notitle
    unset multiplot
    set lmargin
    set rmargin
    set tmargin
    set bmargin
}
set output
