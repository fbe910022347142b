; What the installer says, in English and Japanese.
!macro Say name english japanese
  LangString ${name} ${LANG_ENGLISH} "${english}"
  LangString ${name} ${LANG_JAPANESE} "${japanese}"
!macroend

!insertmacro Say PROJECT "Busk project" "Buskプロジェクト"
!insertmacro Say FILE_TYPE "Open .busk projects with Busk" ".buskプロジェクトをBuskで開く"
!insertmacro Say DESKTOP_LINK "Link on the desktop" "デスクトップにショートカットを作る"
!insertmacro Say ABOUT_PROGRAM "The program, its guide and an entry in the start menu." "プログラム、ガイド、スタートメニューの項目です。"
!insertmacro Say ABOUT_FILE_TYPE "A double click on a project opens it." "プロジェクトをダブルクリックすると開きます。"
!insertmacro Say ABOUT_DESKTOP_LINK "A second way to start it." "デスクトップからも起動できます。"
!insertmacro Say IS_RUNNING "Busk is running. Save your work and close it, then try again." \
  "Buskが起動しています。作業を保存してBuskを終了してから、再試行してください。"
!insertmacro Say TOO_OLD "Busk needs Windows 10 or 11 with 64 bits." "Buskには64ビット版のWindows 10または11が必要です。"
!insertmacro Say FOREIGN_FOLDER "There are other files in this folder. Choose an empty one for Busk." \
  "このフォルダーには他のファイルがあります。空のフォルダーを選んでください。"
