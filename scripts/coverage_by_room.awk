#!/usr/bin/awk -f
# Sums what `llvm-cov report` tells of files by room, src/kaustik/ROOM/… or FOLDER/…: columns 8 and 9
# are a file's lines and those that did not run.
function row(name, lines, missed) {
  printf "%-12s %7d lines, %6d not run  %5.1f %%\n", name, lines, missed, 100 * (1 - missed / lines)
}
/^(Filename|-|TOTAL|Files)/ || NF < 10 { next }
{
  count = split($1, part, "/")
  room = part[1]
  for (i = 1; i + 2 <= count; ++i)
    if (part[i] == "src" && part[i + 1] == "kaustik") room = part[i + 2]
  if (!(room in lines)) order[++rooms] = room
  lines[room] += $8
  missed[room] += $9
  all_lines += $8
  all_missed += $9
}
END {
  if (all_lines == 0) {
    print "coverage_by_room.awk: no file in the report of llvm-cov" >"/dev/stderr"
    exit 1
  }
  for (i = 1; i <= rooms; ++i) row(order[i], lines[order[i]], missed[order[i]])
  row("all", all_lines, all_missed)
}
