/* How well a page answers what is looked for; Sphinx takes it into the search of the guide. */

/* Words of the trade, and the page that answers them first. conf.py makes them keywords of that page. */
const TRADE_WORDS = {
  "first": "begin beginner tutorial customer steps quick start",
  "screens": "screen window tab panel slider shortcut keys preferences variants compare landmarks",
  "guide": "scan import unit landmark nipple apex sliding glued stiffness",
  "sewing": "strap straps band cut length lengths elastic elastics newton newtons tension stretch allowance seam",
  "pressure": "pressure press tight comfort kpa mmhg marks mark digging",
  "sizes": "size sizes cup cups band bra fitting fit chart",
  "report": "report sheet pdf print printing paper",
  "export": "export pattern dxf svg clo seamly strips",
  "measures": "measure measures measurement measurements girth waist hip bust underbust volume depth width",
  "honest": "underwire underwires wire wires wing wings gusset gussets gore seam seams boning gravity accuracy privacy",
  "trouble": "error trouble problem crash slow black backup restore reset",
  "install": "install uninstall remove removal update upgrade download windows mac",
  "method": "method vibration adaptive conventional mesh spring paper",
  "commands": "command terminal script batch",
};

const LATER = new Set(["python", "changes", "commands", "licences", "reproduction", "sweep", "speed", "accuracy"]);

/* Of a page that answers every word asked for; of pages for programmers, unless they answer. */
const ANSWERS = 60, FOR_OTHERS = -30;

/* A word is asked for as it stands, or begun: "pressures" and "pressu" are both answered by "pressure". */
const answered = (page) => {
  const words = (TRADE_WORDS[page] || "").match(/\w+/g) || [];
  const asked = (new URLSearchParams(window.location.search).get("q") || "").toLowerCase().match(/\w{3,}/g) || [];
  return asked.length > 0 && asked.every((ask) => words.some((word) => word.startsWith(ask) || ask.startsWith(word)));
};

var Scorer = {
  score: ([page, , anchor, , score]) => {
    if (answered(page)) return score + ANSWERS + (anchor ? 0 : 1);
    return score + (LATER.has(page) ? FOR_OTHERS : 0);
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 30,
  partialTitle: 12,
  term: 5,
  partialTerm: 2,
};
